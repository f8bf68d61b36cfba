#pragma once
/// @file
/// Epochs of the sensor in the station metadata.
///
/// A data root may contain records of several sensors, or of one with different settings.  Their
/// samples have different scales, so a long record is divided where an epoch ends.
///
///     const std::vector<RecordEpoch> epochs = read_record_epochs(root / "metadata/station.xml");
///     for (std::size_t i = 1; i < epochs.size(); ++i)
///         warn(epochs[i].start, epoch_change(epochs[i - 1], epochs[i]));

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::long_record {

inline constexpr std::size_t kRecordChannels = 4;  // x, y, z, temperature

/// A period with one sensor and one scale of each channel.
///
/// It lasts until the start of the next epoch; the last one has no end.  `scales` are in the order
/// x, y, z in m/s2 and temperature in degC: value = offset + gain x count.  `codes` are those of
/// the archive's file names.  Without a start date `start` is UtcTime::min().
struct RecordEpoch {
    UtcTime start;
    std::string serial_number;  ///< Serial number of the sensor; empty: not known.
    journal::StationCodes codes;
    std::array<station::ChannelScale, kRecordChannels> scales;
    /// Temperature of an outer oven; absent if there is none.
    std::optional<station::ChannelScale> outer = {};
};

/// Reads the epochs in order of time; neighbours differ.  Samples before the first belong to the
/// first.
///
/// Epochs of the file that differ in other things only, for example the firmware, are joined
/// (archive_record_test.cpp).
/// @param metadata  station.xml.
/// @throws InputError  as read_station_xml() and find_channels().
[[nodiscard]] std::vector<RecordEpoch> read_record_epochs(const std::filesystem::path& metadata);

/// Returns the change from one epoch to the next: "another sensor: B after A", "another scale of
/// BNZ", "other channels"; empty if there is none.  The first that applies is returned, in the
/// order sensor, codes and channels, scale.
[[nodiscard]] text::Message epoch_change(const RecordEpoch& before, const RecordEpoch& after);

/// Returns "another sensor: B after A" for two serial numbers.
/// @return empty if both are the same, or if one is not known (empty).
[[nodiscard]] text::Message sensor_change(const std::string& before, const std::string& after);

}  // namespace a351::corrector::long_record
