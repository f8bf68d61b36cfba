#pragma once
/// @file
/// Calibration of one unit, known before a survey, as the file calibration.toml
/// (protocol/unit/calibration-format.md).
///
/// It holds properties of one sensor that are the same on every survey day.  The serial number says
/// which sensor: a calibration of another unit makes results worse.
///
///     const Calibration known = read_calibration("calibration.toml");
///     if (known.thermal) std::exp(value_of(*known.thermal, ThermalTerm::slow_lag));  // s
///
/// All types are plain values without references.  All functions are pure, except that
/// read_calibration() reads its file.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::unit {

/// Estimated coefficients with the covariance of their fit; its users widen it.
///
/// Range: a file is read only if all numbers are finite, covariances are within +-1e12, and the
/// covariance is symmetric and positive definite.  The struct itself checks nothing.
///
/// A default-constructed object has values 0 with standard deviations of 1, which is no
/// measurement.  Comparison is exact: objects with a NaN are never equal.
/// @tparam kCount  number of coefficients.
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
/// The norm is in mGal, the means of the axes are in g.  A tilt by 0.1 deg changes a mean by
/// 0.0017 g, so a bias of 2000 mGal per g changes the norm by 3.5 mGal.
/// Range in a file: +-1e5.
inline constexpr std::array<std::string_view, 2> kAxisBiasNames{"x_mgal_per_g", "y_mgal_per_g"};
/// Biases bx, by with their covariance, (mGal/g)^2.
using AxisBias = CalibratedCoefficients<2>;

/// Thermal response (thermal_response.hpp), in the order and units of kThermalNames.  Range in a
/// file: slopes +-1e4, logarithms of lags 0 to 12 (1 s to two days).
using ThermalResponse = CalibratedCoefficients<static_cast<int>(kThermalTerms)>;

/// Returns a parameter of a thermal response, in the unit of its name; of a lag, ln(s).
[[nodiscard]] inline double value_of(const ThermalResponse& response, ThermalTerm term) {
    return response.values(static_cast<Eigen::Index>(term));
}

/// Returns record_prior() of all coefficients as an estimate with a diagonal covariance.
[[nodiscard]] ThermalResponse record_priors();

/// Factor on the standard errors of a thermal response, dimensionless.  Errors estimated from a
/// record at one point are too small by 1.4 to 2.3 on simulated records.  A user of the covariance
/// multiplies it by the square of this factor.
inline constexpr double kThermalErrorFactor = 2.0;

/// Placement: standard deviation of the scatter of set-ups at one point.
///
/// Range in a file: 0.001 to 1000 mGal, low < standard deviation < high.
struct Placement {
    double mgal = 0.0;                       ///< Standard deviation.
    double low_mgal = 0.0, high_mgal = 0.0;  ///< Its 95 % limits.

    bool operator==(const Placement&) const = default;

    /// Returns the standard error of ln(standard deviation), if that is normal.
    [[nodiscard]] double log_error() const {
        return std::log(high_mgal / low_mgal) / (2.0 * signal::kNormal95);
    }
};

/// Scale factor: change of the reading divided by that of gravity.
///
/// Range in a file: value 0.9 to 1.1, standard error 1e-6 to 0.1.
struct Scale {
    double value = 1.0;
    double standard_error = 0.0;

    bool operator==(const Scale&) const = default;
};

/// Standard deviation of the scale of a unit that nobody has calibrated, about 1.  It is an
/// assumption: the data sheet gives none for a small range.
inline constexpr double kUsualScaleDeviation = 2e-3;

/// Errors of the vertical axis in two faces, each a straight line in the temperature T in degC:
///
///     z up: reading = gravity (1 + scale) + bias,   z down: gravity (1 + scale) - bias
///     bias = bias_mgal + bias_mgal_per_degc (T - 42.5)
///     980665 scale = scale_mgal + scale_mgal_per_degc (T - 42.5)
///
/// 42.5 degC belongs to the format (calibration-format.md).  A quadratic term of the axis is part of
/// the bias.
inline constexpr std::array<std::string_view, 4> kFacesNames{
    "bias_mgal", "scale_mgal", "bias_mgal_per_degc", "scale_mgal_per_degc"};
/// These coefficients with their covariance.  Range in a file: constants +-1e5, slopes +-1e4.
using Faces = CalibratedCoefficients<4>;

/// Share of the scale in a unit's steady response to temperature; the rest acts on the bias.
///
/// The default is that of a unit that nobody has measured: evenly distributed from 0 to 1.
struct ScaleShare {
    double mean = 0.5;
    double deviation = 0.28867513459481287;  ///< Standard deviation, > 0; here 1 / sqrt(12).
    bool is_measured = false;

    bool operator==(const ScaleShare&) const = default;
};

/// Returns K / (B + K) with its standard deviation, from the slopes B of the bias and K of the scale;
/// the default if that is not worse.  The share is not limited: B and K may have opposite signs.
[[nodiscard]] ScaleShare scale_share_of(const Faces& faces);

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

/// Calibration of one unit.
///
/// A file has at least one of axis_bias, thermal, warm_up, placement, scale and faces.  A default-constructed object is not
/// a valid calibration: to_toml() writes it, but parse_calibration() refuses the text.
struct Calibration {
    std::string serial_number;  ///< Serial number of the unit; not empty.
    std::string program;        ///< Program that made the calibration, with its version; not empty.
    UtcTime valid_from;         ///< Start of the validity, for example the first sample used.
    std::optional<UtcTime> valid_to;  ///< Later than valid_from; absent: until a newer calibration.
    std::vector<CalibrationData> data;       ///< Files that were used; may be empty.
    std::optional<AxisBias> axis_bias;       ///< Absent: not measured.
    std::optional<ThermalResponse> thermal;  ///< Absent: not measured.
    std::optional<WarmUpGuidance> warm_up;   ///< Absent: not measured.
    std::optional<Placement> placement;      ///< Absent: not measured.
    std::optional<Scale> scale;              ///< Absent: not measured.
    std::optional<Faces> faces;              ///< Absent: not measured.

    bool operator==(const Calibration&) const = default;
};

/// Returns the text of the file.
///
/// It ends with a newline.  The same calibration gives the same bytes.  Every number has the fewest
/// digits that read back as the same double; times have nine decimals.  Bytes of a text that are
/// not UTF-8 become U+FFFD.
///
/// Accuracy: parse_calibration() gives back the same calibration to the bit (calibration_test.cpp).
/// @param calibration  as read_calibration() accepts it; not checked.
[[nodiscard]] std::string to_toml(const Calibration& calibration);

/// Reads a calibration file.  The unit and the validity are not compared with a survey.
/// @throws InputError  the file cannot be read or is not TOML; a key is unknown, missing or not as
///                     the format requires, such as a number that is NaN or out of range.
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& file);

/// Reads a calibration from text in memory, as read_calibration(); `origin` is the file name shown
/// in messages.  The file itself is not opened.
/// @throws InputError  as read_calibration(); the message begins with `origin`.
[[nodiscard]] Calibration parse_calibration(std::string_view text, std::filesystem::path origin);

}  // namespace a351::unit
