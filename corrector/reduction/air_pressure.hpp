#pragma once
/// @file
/// A record of the air pressure.
///
///     const AirPressure pressure = AirPressure::read("pressure.csv");
///     if (const auto hpa = pressure.at(time)) use(*hpa);

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::reduction {

/// Longest step between two rows.  Reason: weather changes by up to 3 hPa in it, which is 0.001 mGal.
inline constexpr std::chrono::hours kLongestPressureStep{3};

/// Usual counts per hPa of a barometer's channel: its counts are Pa.
inline constexpr double kCountsPerHpa = 100.0;

/// Channel of a barometer that another program writes into the archive of a data root.
struct PressureChannel {
    std::filesystem::path archive;  ///< SDS archive; set by the caller.
    journal::StationCodes codes;    ///< Network, station and location; the axes are not used.
    std::string channel;            ///< Channel code, e.g. LDO.
    double counts_per_hpa = kCountsPerHpa;  ///< From the barometer's own metadata; above 0.

    /// Returns NET.STA.LOC.CHA.
    [[nodiscard]] std::string name() const;
    /// Returns the day files of the interval that exist.
    [[nodiscard]] std::vector<std::filesystem::path> files(UtcTime from, UtcTime to) const;
};

/// Returns the channel of a name NET.STA.LOC.CHA, without archive and sensitivity; absent if it is no
/// such name, or if the second letter of the channel is not D, SEED's letter for pressure.
[[nodiscard]] std::optional<PressureChannel> pressure_channel(const std::string& name);

/// Air pressure by time, from a CSV with the columns time and pressure_hpa, or from an archive.
class AirPressure {
public:
    /// Reads the samples of a channel.  Samples that are not later than the one before are left out,
    /// and so are those that are not within the limits, because nobody can edit an archive.
    /// @param warnings  a sentence with the number of samples outside the limits is added.
    /// @throws InputError  fewer than two samples in the interval, or none within the limits, for
    ///                     example because they are in Pa.
    /// @throws std::system_error  as archive::read_channel().
    [[nodiscard]] static AirPressure read(const PressureChannel& channel, UtcTime from, UtcTime to,
                                          std::vector<text::Message>& warnings);

    /// Reads a file with two rows or more in ascending time.
    /// @throws InputError  a time without zone or not after the one before, a pressure that is not
    ///                     within the limits, fewer than two rows; with file, line and value.
    [[nodiscard]] static AirPressure read(const std::filesystem::path& file);

    /// Returns the pressure, hPa, linear between the rows; absent outside the record and in steps of
    /// more than kLongestPressureStep.
    [[nodiscard]] std::optional<double> at(UtcTime time) const;

private:
    std::vector<UtcTime> times_;
    std::vector<double> values_hpa_;
};

}  // namespace a351::corrector::reduction
