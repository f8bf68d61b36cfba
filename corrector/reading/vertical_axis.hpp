#pragma once
/// @file
/// Which axis of the sensor is vertical, by the samples.
///
/// Gravity itself says it.  The order of the channels in station.xml does not: another program may
/// write the vertical channel first, and a sensor may be mounted on its side.
///
///     const text::Message warning = put_vertical_last(samples, epoch, windows, file);
///     // epoch.channels[kVertical] is the vertical axis now
///     if (!warning.empty()) warnings.push_back(warning);

#include <filesystem>
#include <vector>

#include "corrector/archive_series/epoch.hpp"
#include "corrector/reading/occupation_list.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::reading {

/// Finds the vertical axis (events::vertical_axis()), and exchanges axes of samples and epoch so that it is
/// the last.  The horizontal axes keep their order.
///
/// The size is the median of the windows' means without their signs, over one sample per second: the
/// sensor may be turned over between windows, or lie on its side in some.  Windows with a norm that no box
/// at rest has are left out: their profile was wrong.
/// @param windows  occupations; if none is left, nothing is exchanged.
/// @param file     name of the metadata, for messages.
/// @return a sentence for the user if another axis has a dip of more than 45 deg in the metadata, or
///         if the sensor is always upside down; the norm is the same then.  Otherwise empty.
/// @throws InputError  no axis has a size >= events::kLeastVertical; the message has all three.
[[nodiscard]] text::Message put_vertical_last(std::vector<archive::ChannelData>& samples,
                                              archive_series::Epoch& epoch,
                                              const std::vector<OccupationWindow>& windows,
                                              const std::filesystem::path& file);

/// Exchanges axes so that the one with a dip of more than 45 deg in the metadata is the last; without
/// one nothing is exchanged.  For a sensor that is laid down in several positions.
void put_named_vertical_last(std::vector<archive::ChannelData>& samples,
                             archive_series::Epoch& epoch);

}  // namespace a351::corrector::reading
