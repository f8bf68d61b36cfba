#pragma once
/// @file
/// The terms of the whole-day model, and what is known of them beforehand.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "corrector/adjustment/term.hpp"
#include "corrector/whole_day/day_noise.hpp"
#include "protocol/unit/calibration.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::whole_day {

/// Terms of the model: c, rA, rS, rF, d, w, bx, by, k.
///
/// - constant: c, mGal; level: rA and slow: rS, mGal/degC; fast: rF, mGal/(degC/h).
/// - drift: d, mGal/h; warm_up: w, mGal at the first sample of the temperature.
/// - x: bx and y: by, mGal/g; scale: k, without a unit.
///
/// The values are indices from 0, for example in DayFit::coefficients.
enum class DayTerm { constant, level, slow, fast, drift, warm_up, x, y, scale };
/// Terms of which only the record of a day has the column: the response to its temperature
/// (protocol/unit/thermal_response.hpp), and the warm-up after power-on.
inline constexpr adjustment::Term kLevel{
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::level)],
    adjustment::Correction::temperature, adjustment::Scope::unit, nullptr};
inline constexpr adjustment::Term kSlow{
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::slow)],
    adjustment::Correction::temperature, adjustment::Scope::unit, nullptr};
inline constexpr adjustment::Term kFast{
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::fast)],
    adjustment::Correction::rate, adjustment::Scope::unit, nullptr};
inline constexpr adjustment::Term kWarmUp{"warm_up_mgal", adjustment::Correction::drift,
                                          adjustment::Scope::loop, nullptr};
/// Declarations of the terms, in the order of DayTerm.
inline constexpr std::array kDayTermList{&adjustment::kConstant,
                                         &kLevel,
                                         &kSlow,
                                         &kFast,
                                         &adjustment::kTime,
                                         &kWarmUp,
                                         &adjustment::kAxisX,
                                         &adjustment::kAxisY,
                                         &adjustment::kScaleTerm};
static_assert(kDayTermList.size() == static_cast<std::size_t>(DayTerm::scale) + 1);
static_assert(kDayTermList.back() == &adjustment::kScaleTerm);
/// Number of terms.
inline constexpr std::size_t kDayTerms = kDayTermList.size();

/// Number of lags: fast tF, slow tS.  In DayPriors they are before the terms.
inline constexpr std::size_t kDayLags = 2;

/// kDayLags and kDayTerms as sizes of matrices.
inline constexpr auto kLags = static_cast<Eigen::Index>(kDayLags);
inline constexpr auto kTerms = static_cast<Eigen::Index>(kDayTerms);

/// Standard deviation of the constant, and of the gravity of a station of which nothing is known,
/// mGal: practically no prior.
inline constexpr double kFreeGravity_mgal = 1e4;

/// Names of oA, oS and tO, as in result.json.
inline constexpr std::array<std::string_view, 3> kOuterNames{
    "outer_level_mgal_per_degc", "outer_slow_mgal_per_degc", "outer_lag_s"};
/// Number of slopes of an outer oven: oA, oS.
inline constexpr Eigen::Index kOuterSlopes = 2;
/// Prior of tO, s.  Assumed: minutes to an hour.
inline constexpr LogNormalPrior kOuterLag_s{1200.0, 2.0};
/// Prior of the slopes of an outer oven.  Assumed, because nobody has measured a double oven: the wall
/// hardly acts, or up to as much as the sensor's own slow response (two deviations are 27 mGal/degC).
inline constexpr LogNormalPrior kOuterSize_mgal_per_degc{3.0, 3.0};

/// Joint normal prior: natural logarithms of the lags in seconds, then the terms in their units.
///
/// A default-constructed prior has means 0 and deviations 1, which fits no sensor.  Begin with
/// usual_day_priors():
///
///     DayPriors priors = usual_day_priors();
///     priors.observe({DayPriors::place_of(DayTerm::x)}, Eigen::VectorXd::Constant(1, 900.0),
///                    Eigen::MatrixXd::Constant(1, 1, 400.0));  // bx = 900 +- 20 mGal/g
struct DayPriors {
    /// Number of lags and terms: fast lag, slow lag, then the terms in the order of DayTerm.
    static constexpr int kCount = static_cast<int>(kDayLags + kDayTerms);
    using Vector = Eigen::Matrix<double, kCount, 1>;
    using Matrix = Eigen::Matrix<double, kCount, kCount>;

    Vector mean = Vector::Zero();        ///< Means; of a lag ln(s).
    Matrix factor = Matrix::Identity();  ///< Lower triangular L of the covariance L L'.
    /// The size of bx and by is estimated from the day.  Its log-normal prior has as median the
    /// standard deviations of bx and by in `factor`, and this factor as one deviation, for both
    /// alike.  1: the standard deviations in `factor` are used as they are.
    double bias_factor = 1.0;
    LogNormalPrior placement_mgal = kUsualPlacement_mgal;  ///< Prior of the placement.
    unit::ScaleShare scale_share = {};  ///< Prior of the share of the scale in a unit's errors.
    /// Standard deviation by which the share of a term in the scale differs from the unit's.  Assumed.
    double share_spread = 0.1;

    /// Returns `factor` for a day in one face or two.  The scale that both faces show is the secant, the
    /// reading at 1 g divided by gravity.  That of days in one face and of calibrations is the slope there.
    /// They differ by twice the quadratic term, whose prior is 300 mGal (methods.md, "Calibration").
    [[nodiscard]] Matrix factor_in(bool has_two_faces) const;

    /// Gives bx and by independent deviations of 2000 mGal/g, the limit of the data sheet, whatever
    /// the day says about their size.  Call it before observe() of an axis.
    void free_axes();

    /// Gives the scale factor a prior that is independent of the others.
    /// @param value, deviation  of the scale, not of k.
    void set_scale(double value, double deviation);

    /// Combines the prior with an independent measurement of some of its quantities (Kalman
    /// update).
    ///
    /// The measurement may be very exact: variances down to 1e-20 leave a finite prior with this
    /// standard deviation (day_model_test.cpp).
    ///
    /// Quantities that were not measured change too, if the prior or the measurement correlates
    /// them with others.  Each call is one measurement: do not use the same one twice.
    /// @param places      (m) places of the quantities, see place_of(); 0 and 1 are the lags.
    /// @param values      (m) measured values; of a lag ln(s).
    /// @param covariance  (m, m) of the values, positive definite.
    /// @throws std::invalid_argument  if the resulting covariance is not positive definite.
    void observe(const std::vector<Eigen::Index>& places, const Eigen::VectorXd& values,
                 const Eigen::MatrixXd& covariance);

    /// Returns the index of a term in `mean`, which is also its row and column in `factor`.  The
    /// indices of the lags are 0 (fast) and 1 (slow).
    [[nodiscard]] static constexpr Eigen::Index place_of(DayTerm term) {
        return static_cast<Eigen::Index>(kDayLags) + static_cast<Eigen::Index>(term);
    }
};

/// A parameter that all days of a unit have in common.
struct UnitParameter {
    std::string_view name;   ///< With its unit; of a lag ln(s).
    Eigen::Index place = 0;  ///< In DayPriors.
};
/// Returns the lags, then the terms of the unit in the order of DayTerm, except the scale.
[[nodiscard]] const std::vector<UnitParameter>& unit_parameters();

/// Returns the priors for a unit without calibration; adjust_day() lists them.  All are independent.
/// With a calibration use day_priors_of() (corrector/model/calibration_use.hpp).
[[nodiscard]] DayPriors usual_day_priors();

}  // namespace a351::corrector::whole_day
