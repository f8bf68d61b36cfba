#pragma once
/// @file
/// Bias, scale factor and quadratic term of each axis, from a sensor that is laid down in six or more
/// positions at one point of known gravity (corrector/methods.md, "Calibration").
///
///     m = (1 + S) a + b + q (a / g0)^2,  |a| = gravity + tide
///
/// m is the mean vector of a position, a the true acceleration along the axes, in mGal.
/// - b: biases, mGal; q: quadratic terms, mGal at g0 = 980665 mGal.
/// - b and the diagonal of S change with the temperature in straight lines.
/// - S: symmetric; scale factors minus 1 on its diagonal, half the angles between axes minus 90 deg
///   (with the opposite sign, rad) beside it.
///
/// The positions need no levelling: |a| is known in any of them.
///
///     const Tumble tumble = measure_tumble(read, "tumble");
///     calibration.scale = tumble.scale;

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "corrector/reading/occupation_rows.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::series {

/// A measured value with its standard deviation, which contains the prior.
struct TumbleTerm {
    double value = 0.0, standard_error = 0.0;
    /// True: the standard error is below half of the one that the priors alone give.  For a bias and
    /// the slope this is that of the quadratic term, because bias and scale are free.
    bool is_determined = false;
};

/// Result for one axis.
struct TumbleAxis {
    TumbleTerm zero_mgal;       ///< Half the sum of up and down: bias + quadratic term.
    TumbleTerm scale;           ///< Half the difference of up and down, divided by gravity.
    TumbleTerm bias_mgal;       ///< Bias alone.
    TumbleTerm quadratic_mgal;  ///< Quadratic term at 1 g.
    /// Changes of the bias and, times 980665 mGal, of the scale with temperature.
    TumbleTerm bias_mgal_per_degc, scale_mgal_per_degc;
};

/// Result of a tumble.
struct Tumble {
    std::array<TumbleAxis, 3> axes;  ///< x, y, z; z is the axis that the metadata call vertical.
    std::array<TumbleTerm, 3> angle_rad;  ///< 90 deg minus the angle of x y, x z, y z.
    TumbleTerm slope;   ///< Change of the reading divided by that of gravity, z upwards.
    unit::Scale scale;  ///< `slope`, for calibration.toml.
    /// Change of the norm by 1 g along x and y, z upwards; absent if not determined.
    std::optional<unit::AxisBias> axis_bias;
    /// Bias and scale of z with their changes by temperature; absent if these are not determined.
    std::optional<unit::Faces> faces;
    std::size_t positions = 0;                 ///< Number of positions used.
    double mean_degc = 0.0, range_degc = 0.0;  ///< Temperature of the positions.
    MilliGal gravity;                          ///< Gravity of the site.
    std::optional<MilliGal> u_gravity;         ///< Its uncertainty; absent: counted as exact.
    double expected_mgal = 0.0;                ///< Rms error expected of a position.
    std::optional<double> residual_mgal;       ///< Rms error found; absent if nothing is left over.
};

/// Measures a tumble.
///
/// Weighted least squares with priors, iterated until no error of linearisation is left.  Deviations of
/// the priors: bias 1e5 mGal and scale 0.1, which decide nothing; quadratic term 300 mGal and angle 3 mrad,
/// from the data sheet; changes of each bias and scale with temperature 100 mGal/degC at 1 g, from the
/// data sheet; gravity its uncertainty.  Errors of a position: placement and flicker of a usual unit, and the
/// standard error of its mean.  Residuals larger than expected enlarge these errors, smaller ones do not
/// make them smaller.
///
/// Six positions give the scale between -1 g and +1 g and the sum of bias and quadratic term of each
/// axis.  The change of the reading around +1 g is the scale plus twice the quadratic term divided by
/// gravity, so its error is that of the prior, 6e-4.  Twelve more positions, each with two axes at
/// 45 deg, determine all terms.
///
/// Positions at two or more temperatures give the changes with temperature, and so the share of the scale
/// in them (unit::scale_share_of()).
///
/// Accuracy (tumble_series_test.cpp): of 100 made-up units at 20, 30 and 42.5 degC the errors of bias,
/// scale and their changes are 0.95 to 1.05 of their uncertainties (rms).  In twenty made-up tumbles of eighteen positions the 95 % limits
/// contain the truth of each term in at least 17.
/// @param read    rows and records, SurveySource::is_tumbled; or those of several tumbles of one unit,
///                one after the other.
/// @param origin  name of the series, for messages.
/// @throws InputError  if positions are at several points or gravity is not known, or if an axis has
///                     no position up or none down.
[[nodiscard]] Tumble measure_tumble(const reading::OccupationRows& read, const std::string& origin);

/// Names of the axes.
inline constexpr std::array<std::string_view, 3> kTumbleAxes{"x", "y", "z"};
/// Names of the pairs of axes, in the order of Tumble::angle_rad.
inline constexpr std::array<std::string_view, 3> kTumblePairs{"x and y", "x and z", "y and z"};

}  // namespace a351::corrector::series
