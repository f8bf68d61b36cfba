#pragma once
/// @file
/// StationXML 1.2 (FDSN) of the sensor, written by the daemon and read by the corrector.

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
    UtcTime start;        ///< Start of the epoch.
    std::string profile;  ///< Name of the wire::DeviceProfile.
    bool is_profile_verified = false;
    std::string product_id;
    std::string serial_number;
    std::uint16_t firmware = 0;
    int output_rate_hz = 0;
    std::string filter;
    Nanoseconds group_delay{0};
    std::optional<double> declared_rate_hz;
    bool has_oven = false;                  ///< True if the archive has the oven's channels.
    std::chrono::seconds oven_interval{1};  ///< Sample interval of the oven's channels.
};

/// Returns the StationXML of a new station: all channels begin their first epoch at `start`.
/// @throws std::invalid_argument  the profile is unknown.
[[nodiscard]] std::string to_station_xml(const StationDescription& description);

/// Returns the content of a file, extended by a description.  A channel that differs from the
/// description ends its epoch at `start` and begins a new one.  Earlier epochs are kept.  Stations
/// with other codes are kept too, but their open epochs end at `start`.
/// @return std::nullopt if the file needs no change.
/// @throws InputError             as read_station_xml().
/// @throws std::invalid_argument  the profile is unknown.
[[nodiscard]] std::optional<std::string> extend_station_xml(const std::filesystem::path& file,
                                                            const StationDescription& description);

/// Conversion of a channel's counts to physical values: value = offset + gain x counts.
struct ChannelScale {
    std::string code;     ///< Channel, e.g. BNZ.
    double gain = 0.0;    ///< Value of one count, in `unit`.
    double offset = 0.0;  ///< Value at 0 counts, in `unit`.
    std::string unit;     ///< "m/s**2", "degC", "%" or "s".
};

struct StationMetadata {
    StationCodes codes;
    std::vector<ChannelScale> channels;
    std::string serial_number = {};  ///< Serial number of the sensor; empty if unknown.
};

/// Reads codes, scales and serial number of the station.
/// @param at  time of the epochs to read; without it, or if none was in force then, the open ones.
/// @throws InputError  the file is missing, is not StationXML, lacks a response, or does not have
///                     three acceleration channels.
[[nodiscard]] StationMetadata read_station_xml(const std::filesystem::path& file,
                                               std::optional<UtcTime> at = std::nullopt);

}  // namespace a351::record
