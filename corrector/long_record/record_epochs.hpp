#pragma once
/// @file
/// What station metadata say of the sensor over the time of a record.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::corrector {

inline constexpr std::size_t kRecordChannels = 4;  // x, y, z, temperature

/// A time with one sensor and one scale of its channels.
struct RecordEpoch {
    UtcTime start;
    std::string serial_number;  ///< Empty: not told.
    record::StationCodes codes;
    std::array<record::ChannelScale, kRecordChannels> scales;
};

/// In order of time; neighbours differ.  Samples before the first belong to the first.
/// @throws InputError  as read_station_xml() and find_channels().
[[nodiscard]] std::vector<RecordEpoch> read_record_epochs(const std::filesystem::path& metadata);

/// What is new in an epoch: "another sensor: B after A", "another scale of BNZ", "other channels".
[[nodiscard]] std::string epoch_change(const RecordEpoch& before, const RecordEpoch& after);

/// @return empty where both are the same, or one is not told.
[[nodiscard]] std::string sensor_change(const std::string& before, const std::string& after);

}  // namespace a351::corrector
