#pragma once
/// @file
/// From samples of the archive to the regular record of one occupation.
///
///     // read once for the whole survey
///     const auto samples = archive_series::read_samples(root, epoch, span);
///     const auto record = cut_occupation(samples, epoch, window.start, window.end);
///     if (!record) leave_out(...);
///
/// The function is pure, so several occupations may be cut at once.

#include <optional>
#include <vector>

#include "corrector/archive_series/epoch.hpp"
#include "corrector/reading/decimated_axes.hpp"
#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::reading {

/// Returns the record of one occupation, axes in g.  The temperature extends 10 s (500 samples at
/// 50 Hz) beyond it on both sides.
///
/// The grid is that of the vertical axis; x and y are placed on it.  A horizontal axis or a
/// temperature without samples is NaN throughout, which is no error.
///
/// @param samples     of the channels of `epoch`, in their order.
/// @param start, end  window [start, end), start <= end.
/// @return std::nullopt without a sample of the vertical axis in the window.
[[nodiscard]] std::optional<OccupationRecord> cut_occupation(
    const std::vector<archive::ChannelData>& samples, const archive_series::Epoch& epoch,
    UtcTime start, UtcTime end);

}  // namespace a351::corrector::reading
