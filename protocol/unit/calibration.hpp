#pragma once
/// @file
/// What is known of one unit before a survey, as the file calibration.toml
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

/// Estimates with the covariance as it came out of their fit; users widen it.
template <int kCount>
struct CalibratedCoefficients {
    Eigen::Matrix<double, kCount, 1> values = Eigen::Matrix<double, kCount, 1>::Zero();
    Eigen::Matrix<double, kCount, kCount> covariance =
        Eigen::Matrix<double, kCount, kCount>::Identity();

    bool operator==(const CalibratedCoefficients&) const = default;
};

/// Biases of the horizontal axes: what 1 g along the axis changes in the norm.
inline constexpr std::array<std::string_view, 2> kAxisBiasNames{"x_mgal_per_g", "y_mgal_per_g"};
using AxisBias = CalibratedCoefficients<2>;

/// The response to temperature, as fit_day() (corrector/whole_day/day_model.hpp) has it: rA, rS, rF, and
/// natural logarithms of the lags tF, tS in seconds.
inline constexpr std::array<std::string_view, 5> kThermalNames{
    "temperature_mgal_per_degc", "slow_temperature_mgal_per_degc", "rate_mgal_per_degc_per_h",
    "fast_lag_ln_s", "slow_lag_ln_s"};
using ThermalResponse = CalibratedCoefficients<5>;

/// Errors of a thermal response that were estimated from a record at one point come out too small
/// by 1.4 to 2.3 on simulated records: they count as so many times as large.
inline constexpr double kThermalErrorFactor = 2.0;

struct WarmUpGuidance {
    double within_mgal = 1.0;       ///< Of the reading's final value, > 0.
    double after_power_on_h = 0.0;  ///< >= 0

    bool operator==(const WarmUpGuidance&) const = default;
};

/// A file that was measured from.
struct CalibrationData {
    std::string name;    ///< Without directory.
    std::string sha256;  ///< 64 lower-case hexadecimal digits.

    bool operator==(const CalibrationData&) const = default;
};

struct Calibration {
    std::string serial_number;  ///< Of the unit; not empty.
    std::string program;        ///< That made it, with its version.
    UtcTime valid_from;
    std::optional<UtcTime> valid_to;  ///< Absent: until a newer one.
    std::vector<CalibrationData> data;
    std::optional<AxisBias> axis_bias;
    std::optional<ThermalResponse> thermal;
    std::optional<WarmUpGuidance> warm_up;

    bool operator==(const Calibration&) const = default;
};

/// The file's text; read back it gives the same to the bit.
[[nodiscard]] std::string to_toml(const Calibration& calibration);

/// @throws InputError  a key that is unknown, missing or not what the format allows.
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& file);

/// The same from text in memory; `origin` stands for the file name in messages.
[[nodiscard]] Calibration parse_calibration(std::string_view text, std::filesystem::path origin);

}  // namespace a351::corrector
