#pragma once
/// @file
/// A record of the air pressure.
///
///     const AirPressure pressure = AirPressure::read("pressure.csv");
///     if (const auto hpa = pressure.at(time)) use(*hpa);

#include <chrono>
#include <filesystem>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::corrector::reduction {

/// Limits of a pressure on the ground, hPa.  Reason: 1084 was the highest ever measured; on Mount
/// Everest it is 330.
inline constexpr double kLeastPressure_hpa = 300.0, kGreatestPressure_hpa = 1100.0;

/// Longest step between two rows.  Reason: weather changes by up to 3 hPa in it, which is 0.001 mGal.
inline constexpr std::chrono::hours kLongestPressureStep{3};

/// Air pressure by time, from a CSV with the columns time and pressure_hpa.
class AirPressure {
public:
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
