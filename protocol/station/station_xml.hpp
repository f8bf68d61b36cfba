#pragma once
/// @file
/// StationXML 1.2 (FDSN) of the sensor, written by the daemon and read by the corrector.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::record {

struct StationDescription {
    StationCodes codes;
    Degrees latitude, longitude;
    Metres elevation;
    UtcTime start;        ///< Of the epoch.
    std::string profile;  ///< wire::DeviceProfile by name.
    bool is_profile_verified = false;
    std::string product_id;
    std::string serial_number;
    std::uint16_t firmware = 0;
    int output_rate_hz = 0;
    std::string filter;
    Nanoseconds group_delay{0};
    std::optional<double> declared_rate_hz;
    bool has_oven = false;                  ///< Its channels are in the archive.
    std::chrono::seconds oven_interval{1};  ///< From sample to sample of them.
};

/// With all channels beginning their first epoch at `start`.
/// @throws std::invalid_argument  the profile is unknown.
[[nodiscard]] std::string to_station_xml(const StationDescription& description);

/// The file, extended: a channel that says something else than the description ends its epoch at
/// `start` and begins a new one; earlier epochs stay, and so do those of other codes.
/// @return std::nullopt when the file says all that already.
/// @throws InputError             as read_station_xml().
/// @throws std::invalid_argument  the profile is unknown.
[[nodiscard]] std::optional<std::string> extend_station_xml(const std::filesystem::path& file,
                                                            const StationDescription& description);

/// How counts of a channel become physical values: value = offset + gain x counts.
struct ChannelScale {
    std::string code;   ///< Channel, e.g. BNZ.
    double gain = 0.0;  ///< Per count, in `unit`.
    double offset = 0.0;
    std::string unit;  ///< "m/s**2", "degC", "%" or "s".
};

struct StationMetadata {
    StationCodes codes;
    std::vector<ChannelScale> channels;
    std::string serial_number = {};  ///< Of the sensor; empty: not told.
};

/// @param at  of epochs that follow each other those in force then, else those that go on.
/// @throws InputError  the file is missing, is not StationXML, or lacks a response.
[[nodiscard]] StationMetadata read_station_xml(const std::filesystem::path& file,
                                               std::optional<UtcTime> at = std::nullopt);

}  // namespace a351::record
