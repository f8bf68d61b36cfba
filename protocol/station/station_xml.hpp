#pragma once
/// @file
/// StationXML 1.2 (FDSN) of the sensor, written by the daemon and read by the corrector.
///
/// A file has one epoch per channel and setting: from `startDate` until before `endDate`.  An epoch
/// without `endDate` is open.  A change of sensor, settings or position ends open epochs and begins
/// new ones, so old samples keep their scale.
///
///     const auto text = std::filesystem::exists(file) ? extend_station_xml(file, description)
///                                                     : to_station_xml(description);
///     if (text) replace_file(files, file, std::as_bytes(std::span(*text)));
///
/// No function here writes a file.  All may be called from several threads.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::station {

/// Station, sensor and settings, as the daemon knows them at the begin of a session.
///
/// The values are not checked, except for the profile.  Sensor, filter and rates belong to the
/// sampled channels; the position belongs to all channels.
struct Description {
    journal::StationCodes codes;  ///< Valid codes, see are_valid().
    Degrees latitude, longitude;  ///< Position, WGS 84 in StationXML; north and east positive.
    Metres elevation;             ///< Elevation of station and channels; their depth is 0.
    UtcTime start;                ///< Start of the epoch.
    std::string profile;          ///< Name of the wire::DeviceProfile.
    /// True if the values of the profile are documented for this device; written as a comment.
    bool is_profile_verified = false;
    /// Model and serial number as the device reports them.  In the file a question mark replaces
    /// each character that is not printable ASCII.
    std::string product_id;
    std::string serial_number;
    std::uint16_t firmware = 0;  ///< Version as the device reports it; written as a comment.
    /// Result of the sensor's last start-up test; written as a comment unless it is passed.
    wire::StartUpTest start_up_test = wire::StartUpTest::passed;
    int output_rate_hz = 0;  ///< Nominal output rate, > 0; also gives the band code.
    std::string filter;      ///< Name of the filter, e.g. k512_fc9; written as a comment.
    /// Group delay of the filter, already subtracted from the time stamps; written as a comment.
    Nanoseconds group_delay{0};
    /// Rate of blockette 100, Hz.  Its difference to the nominal rate becomes the clock drift, in
    /// seconds per sample and without a sign.
    std::optional<double> declared_rate_hz;
    bool has_oven = false;                  ///< True if the archive has the oven's channels.
    std::chrono::seconds oven_interval{1};  ///< Sample interval of the oven's channels, >= 1 s.
    bool has_outer_oven = false;            ///< True if the archive has the outer oven's channels.
    std::chrono::seconds outer_oven_interval{1};  ///< The same of the outer oven's channels.
};

/// Returns the StationXML of a new station: all channels begin their first epoch at `start`.
///
/// The channels are those of the archive: three axes in the order x, y, z, the raw temperature, and
/// the derived ones.  The oven's channels are among them if `has_oven` is true.
///
/// The sensitivity of an axis is 2^bits / 9.80665 counts per m/s2, flat from 0 Hz.  The bits are
/// the fraction bits of the profile.  The text has all digits of the double (station_xml_test.cpp).
///
/// An axis whose last letter is not Z, N or E is marked as not surveyed.
///
/// Deterministic: no clock is read, and the time of creation is `start`.
/// @throws std::invalid_argument  the profile is unknown.
[[nodiscard]] std::string to_station_xml(const Description& description);

/// Returns the content of a file, extended by a description.  A channel that differs from the
/// description ends its epoch at `start` and begins a new one.  Earlier epochs are kept.  Stations
/// with other codes are kept too, but their open epochs end at `start`.
///
/// A new position overwrites that of the station.  The old one remains in the ended epochs of the
/// channels.  If the axes get other letters, all three begin a new epoch.
///
/// An open epoch may begin after `start`, because the host's clock was ahead.  If its content is
/// unchanged, its begin moves back to `start`.  Otherwise it ends at its own begin, and no epoch
/// ends before it begins.
///
/// A second call with the result as file returns std::nullopt (station_epochs_test.cpp).
/// @return std::nullopt if the file needs no change.
/// @throws InputError             the file is missing or is not StationXML, or a channel lacks a
///                                usable response or has a date that is not an instant.
/// @throws std::invalid_argument  the profile is unknown.
[[nodiscard]] std::optional<std::string> extend_station_xml(const std::filesystem::path& file,
                                                            const Description& description);

/// Conversion of a channel's counts to physical values: value = offset + gain x counts.
///
/// The gain of an axis or a derived channel is 1 / sensitivity, and its offset is 0.  Those of the
/// raw temperature are the two coefficients of its polynomial; its gain may be negative.
struct ChannelScale {
    std::string code;     ///< Channel, e.g. BNZ.
    double gain = 0.0;    ///< Value of one count, in `unit`.
    double offset = 0.0;  ///< Value at 0 counts, in `unit`.
    std::string unit;     ///< "m/s**2", "degC", "%" or "s".
    std::optional<double> rate_hz = {};  ///< Rate of the samples; absent if the file has none.
    /// Dip of the channel, deg, positive down; absent if the file has none.
    std::optional<double> dip_deg = {};
};

/// Position of a station, WGS 84 in StationXML; north and east positive.
struct Position {
    Degrees latitude, longitude;
    Metres elevation;
};

/// Content of a station's epochs at one instant.
struct Metadata {
    /// Codes of the station.  `axes` are the last letters of the acceleration channels in the order
    /// of the file, which is x, y, z in files of this project.
    journal::StationCodes codes;
    /// Scales in the order of the file, one per channel code.
    std::vector<ChannelScale> channels;
    std::string serial_number = {};         ///< Serial number of the sensor; empty if unknown.
    std::optional<Position> position = {};  ///< Absent if the file has none.
    /// Noise of an axis by its data sheet, DeviceProfile::noise_ug_per_sqrt_hz of the shipped profile
    /// that a comment names; absent without one.
    std::optional<double> noise_ug_per_sqrt_hz = {};
};

/// Reads codes, scales and serial number of the station.
///
/// The result is that of the first station in the file that has an epoch at the instant asked for.
/// If two epochs of a channel include the instant, the later one in the file counts.
///
/// All channels of the file are checked, also those of other stations and epochs.  Codes are not
/// checked: a caller that makes paths of them calls are_valid() first.
/// @param at  instant at which the metadata are wanted, for example the begin of a survey.  Epochs
///            with startDate <= at < endDate are read.  If `at` is absent, or if no epoch includes
///            it, the open epochs are read: those without endDate.
/// @return the metadata with three acceleration channels: those with N as second letter.
/// @throws InputError  the file is missing, is not StationXML, lacks a response, or does not have
///                     three acceleration channels.  A number or a date that cannot be read, and a
///                     sensitivity that is not positive, are refused too.
[[nodiscard]] Metadata read_station_xml(const std::filesystem::path& file,
                                        std::optional<UtcTime> at = std::nullopt);

/// Reads the metadata at each instant at which an epoch of a channel begins, in order of time.
///
/// A channel without a start date begins at UtcTime::min().
/// @throws InputError  as read_station_xml().
[[nodiscard]] std::map<UtcTime, Metadata> read_station_epochs(const std::filesystem::path& file);

}  // namespace a351::station
