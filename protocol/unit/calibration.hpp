#pragma once
/// @file
/// Calibration of one unit, known before a survey, as the file calibration.toml
/// (protocol/unit/calibration-format.md).

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Estimated coefficients with the covariance of their fit; its users widen it.
///
/// Range: a file is read only if all numbers are finite, covariances are within +-1e12, and the
/// covariance is symmetric and positive definite.  The struct itself checks nothing.
template <int kCount>
struct CalibratedCoefficients {
    /// Values (kCount), in the order and units of the names below.
    Eigen::Matrix<double, kCount, 1> values = Eigen::Matrix<double, kCount, 1>::Zero();
    /// Covariance (kCount, kCount), in the squares of these units.
    Eigen::Matrix<double, kCount, kCount> covariance =
        Eigen::Matrix<double, kCount, kCount>::Identity();

    bool operator==(const CalibratedCoefficients&) const = default;
};

/// Biases of the horizontal axes, mGal per g: change of the norm caused by 1 g along the axis.
///
///     norm - bx mean(x) - by mean(y)    does not depend on levelling
///
/// Range in a file: +-1e5.
inline constexpr std::array<std::string_view, 2> kAxisBiasNames{"x_mgal_per_g", "y_mgal_per_g"};
using AxisBias = CalibratedCoefficients<2>;

/// Response to the temperature T, as in fit_day() (corrector/whole_day/day_model.hpp):
///
///     rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///
/// Order and units: rA, rS in mGal/degC; rF in mGal/(degC/h); natural logarithms of the lags tF and
/// tS in seconds.  Range in a file: slopes +-1e4, logarithms of lags 0 to 12 (1 s to two days).
inline constexpr std::array<std::string_view, 5> kThermalNames{
    "temperature_mgal_per_degc", "slow_temperature_mgal_per_degc", "rate_mgal_per_degc_per_h",
    "fast_lag_ln_s", "slow_lag_ln_s"};
using ThermalResponse = CalibratedCoefficients<5>;

/// Factor on the standard errors of a thermal response, dimensionless.  Errors estimated from a
/// record at one point are too small by 1.4 to 2.3 on simulated records.
inline constexpr double kThermalErrorFactor = 2.0;

/// Time to wait after power-on: from then on the reading, corrected for temperature, is within
/// `within_mgal` of its final value, with 95 % confidence.
struct WarmUpGuidance {
    double within_mgal = 1.0;       ///< Limit, mGal; 0.001 to 1000 in a file.
    double after_power_on_h = 0.0;  ///< Time after power-on, h; 0 to 1000 in a file.

    bool operator==(const WarmUpGuidance&) const = default;
};

/// File with measurements from which the calibration was made.
struct CalibrationData {
    std::string name;    ///< File name without directory.
    std::string sha256;  ///< 64 lower-case hexadecimal digits.

    bool operator==(const CalibrationData&) const = default;
};

struct Calibration {
    std::string serial_number;  ///< Serial number of the unit; not empty.
    std::string program;        ///< Program that made the calibration, with its version; not empty.
    UtcTime valid_from;
    std::optional<UtcTime> valid_to;  ///< Later than valid_from; absent: until a newer calibration.
    std::vector<CalibrationData> data;
    std::optional<AxisBias> axis_bias;
    std::optional<ThermalResponse> thermal;
    std::optional<WarmUpGuidance> warm_up;

    bool operator==(const Calibration&) const = default;
};

/// Returns the text of the file.
///
/// Accuracy: parse_calibration() gives back the same calibration to the bit (calibration_test.cpp).
/// @param calibration  as read_calibration() accepts it; not checked.
[[nodiscard]] std::string to_toml(const Calibration& calibration);

/// Reads a calibration file.
/// @throws InputError  the file cannot be read or is not TOML; a key is unknown, missing or not as
///                     the format requires, such as a number that is NaN or out of range.
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& file);

/// Reads a calibration from text in memory, as read_calibration(); `origin` is the file name shown
/// in messages.
[[nodiscard]] Calibration parse_calibration(std::string_view text, std::filesystem::path origin);

}  // namespace a351::corrector
