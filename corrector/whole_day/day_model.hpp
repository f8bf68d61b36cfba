#pragma once
/// @file
/// Model of all set-ups of a day together: effects of temperature, drift, tilt and noise on the
/// reading.
///
///     reading = g + tide + c + rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///               + d (t - t0) + w exp(-t / 2.5 h) + bx x + by y + k (g - g0) + steps + placement
///               + flicker + white + oA To + oS lag(To, tO)
///
/// Readings are in mGal, T in degC, rF in mGal/(degC/h), t in h, lags tF and tS in s, x and y in g.
/// A reading is the mean of a bin, and so are T, lag(T, tau), x and y.
/// - T0: 42.5 degC, the set point of the publication's oven.  It only shifts c.
/// - t: time of a bin since the first sample of the temperature record, which counts as power-on.
/// - t0: middle between the first and the last bin of the day.  It only shifts c.
/// - rA, rF, rS, lag(T, tau): the unit's thermal response (protocol/unit/thermal_response.hpp), in
///   equilibrium at the start of the record.
/// - w: warm-up after power-on, which the thermometer does not see.
/// - steps: an unknown offset from each step on (DayStation::steps).
/// - k: scale factor minus 1; g0 is the gravity of the first set-up that is held.
/// - bx, by: biases of the horizontal axes, which a tilt turns into the norm.
/// - placement, flicker, white: noise (day_noise.hpp).
/// - To: temperature of an outer oven, if the box has one; oA and oS in mGal/degC, tO in s.
///
/// Order of the set-ups: they are numbered from 0 in order of time.  The bins are in order of
/// set-up, and in order of time within it; all bins of a set-up are together.  Element s of the
/// stations belongs to set-up s.  Nothing of this is checked: another order gives a wrong
/// covariance of the noise, without an error.
///
/// Begin the temperature two hours or more before the first bin, because tS is 45 min and the lags
/// begin in equilibrium.  Drives between the set-ups belong to it.
///
///     std::vector<DayStation> stations;
///     for (const SurveyRow& row : rows)  // one row per set-up
///         stations.push_back({row.reference, stations.size()});
///     stations[3].gravity.reset();       // to be found
///     const auto fit = fit_day(record, stations);
///     fit->gravity_mgal[3].value;        // its gravity
///
/// Methods and figures: corrector/methods.md, "The whole-day model".

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "corrector/reading/day_record.hpp"
#include "corrector/whole_day/day_noise.hpp"
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
/// Number of terms.
inline constexpr std::size_t kDayTerms = 9;
/// Names of the terms with their units, as in result.json, where `scale` is 1 + k.
inline constexpr std::array<std::string_view, kDayTerms> kDayTermNames{
    "constant_mgal",
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::level)],
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::slow)],
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::fast)],
    "time_mgal_per_h",
    "warm_up_mgal",
    "x_mgal_per_g",
    "y_mgal_per_g",
    "scale"};

/// Number of lags: fast tF, slow tS.  In DayPriors they are before the terms.
inline constexpr std::size_t kDayLags = 2;

/// Names of oA, oS and tO, as in result.json.
inline constexpr std::array<std::string_view, 3> kOuterNames{
    "outer_level_mgal_per_degc", "outer_slow_mgal_per_degc", "outer_lag_s"};
/// Prior of tO, s.  Assumed: minutes to an hour.
inline constexpr LogNormalPrior kOuterLag_s{1200.0, 2.0};

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

/// Returns the priors for a unit without calibration; fit_day() lists them.  All are independent.
/// With a calibration use day_priors_of() (corrector/model/calibration_use.hpp).
[[nodiscard]] DayPriors usual_day_priors();

/// The station of a set-up: its gravity is held or unknown.
struct DayStation {
    std::optional<MilliGal> gravity;  ///< Reference that is held; absent: unknown.
    /// Number of the station from 0.  Set-ups of one number share gravity; it is held if
    /// one of them has a reference.
    std::size_t number = 0;
    MilliGal u_gravity{};  ///< Standard uncertainty of the reference; 0: it is exact.
    /// Number of steps before the set-up: its reading has the offsets of all of them.
    std::size_t steps = 0;
};

/// An estimated value.
struct Estimate {
    double value = 0.0;           ///< Posterior mean.
    double standard_error = 0.0;  ///< Posterior standard deviation, in the unit of the value.
};

/// Sources of the uncertainty of gravity, in the order of GravityEstimate::parts_mgal.
///
/// - placement, flicker, white: the three parts of the noise.
/// - levelling: the biases bx and by.
/// - thermal: both lags, rA, rS, rF, oA, oS and what gaps of the temperature left in the
///   instrument.
/// - drift: d and w.
/// - datum: the references that are held.
/// - scale: k.
enum class ErrorSource { placement, flicker, white, levelling, thermal, drift, datum, scale };
/// Number of sources.
inline constexpr std::size_t kErrorSources = 8;
/// Number of the unit's parameters in GravityEstimate::shared_mgal.
inline constexpr std::size_t kSharedErrors = 8;

/// The gravity of a station, estimated or held.
struct GravityEstimate : Estimate {
    /// Contributions of the sources to the standard error, mGal; the sum of their squares is its
    /// square (JCGM 100:2008, 5.1.2).  All 0 if an exact reference is held.
    std::array<double, kErrorSources> parts_mgal{};
    /// Contributions of the unit's parameters, whose priors several days of one unit have in common:
    /// how the estimate answers to one deviation of the fast lag, the slow lag, rA, rS, rF, bx, by
    /// and k, mGal.  All 0 if an exact reference is held.  Each day decides the size of oA and oS,
    /// so that they are not among them.
    std::array<double, kSharedErrors> shared_mgal{};
    /// The same for the gravities, by their numbers: of a reference that is held, one deviation is its
    /// uncertainty.  0 for exact references, practically 0 for unknown gravities.
    std::vector<double> of_gravities_mgal;
};

/// One set-up.  Effects are means over its bins, mGal, with the sign that they have in the reading.
///
/// A bin counts by its number of samples.  A correction is minus an effect.  The effect of the drift
/// contains the steps, that of the slow term the outer oven's.
struct DaySetUp {
    MilliGal reading;                             ///< Mean reading, the full value.
    MilliGal tide;                                ///< Mean effect of the tide on gravity.
    DegC temperature;                             ///< Mean temperature.
    double rate_degc_per_h = 0.0;                 ///< (T - lag(T, tF)) / tF.
    std::array<double, kDayTerms> effect_mgal{};  ///< Effects in the order of DayTerm.
    MilliGal flicker;  ///< Estimated flicker, with the rest of the white noise.
    /// reading - tide - effects - flicker: gravity and placement.  If gravity is held, it is the
    /// held value (or the value between an uncertain reference and the readings) plus the estimated
    /// placement, and so in sample.
    MilliGal corrected;
};

/// The response to the temperature of an outer oven.
struct OuterResponse {
    std::array<Estimate, 2> mgal_per_degc;  ///< oA and oS; errors with the lag held.
    double lag_s = 0.0;                     ///< Most likely lag tO.
};

/// Result of fit_day().
struct DayFit {
    /// Lags, placement, flicker, white, size of the axis biases, lag and size of the outer oven's
    /// effect: deviations from their priors in standard deviations.  The last two are 0 without an
    /// outer oven.
    using Point = std::array<double, 8>;

    Point point{};  ///< Most likely point; 0: medians of the priors.
    /// The same with the roots of the expected variances (DayProblem::expected()).
    Point expected{};
    DayNoise noise;                                ///< Most likely noise.
    double fast_lag_s = 0.0, slow_lag_s = 0.0;     ///< tF, tS.
    std::array<double, 2> lag_log_errors{};        ///< Standard errors of ln tF and ln tS.
    std::array<Estimate, kDayTerms> coefficients;  ///< Errors include those of the lags.
    std::vector<GravityEstimate> gravity_mgal;     ///< Gravity of the stations, by their numbers.
    std::vector<Estimate> steps_mgal;              ///< Offsets of the steps, in order of time.
    std::optional<OuterResponse> outer;            ///< Absent without an outer oven.
    /// Standard errors of the logarithms of placement, flicker and white, from the curvature of the
    /// likelihood; absent if it has no maximum there.
    std::optional<std::array<double, 3>> noise_log_errors;
    /// Posterior mean of lags and terms, in coordinates in which their priors are independent and
    /// of variance 1: estimate - prior mean = factor x shift, with the rows of bx and by in the size
    /// that the day decided.
    DayPriors::Vector shift = DayPriors::Vector::Zero();
    /// Posterior covariance of `shift`.
    DayPriors::Matrix shift_covariance = DayPriors::Matrix::Identity();
    std::vector<DaySetUp> set_ups;  ///< One per set-up, in the order of the stations.
};

/// Fits the whole-day model.
///
/// Coefficients and unknowns: generalised least squares with priors.  Lags and noise: largest
/// restricted likelihood times their priors.  Standard errors: posterior covariance with the lags
/// to first order, at the expected noise, which is larger than the most likely one.
///
/// Stations of known gravity determine the instrument; unknown stations follow from it.  To find the
/// error of the method, fit again with the gravity of a known station removed and compare.
///
/// Usual priors, mean and standard deviation:
/// - rA -12, 7.2 mGal/degC; rS -20, 12 mGal/degC; rF 11.3, 6.8 mGal/(degC/h)
/// - k 0, 0.002
/// - d 0, 1 mGal/h; w 0, 36 mGal; c, unknowns and steps free (0, 1e4 mGal)
///
/// Log-normal priors, median and factor:
/// - lags 43 s and 2700 s, 1.5; tO 1200 s, 2
/// - placement, if it was not measured, and flicker 1.2 mGal, 2; white the scatter of the bins, 2
/// - common standard deviation of bx and by, whose mean is 0, 300 mGal/g, 3
/// - common standard deviation of oA and oS, whose mean is 0, 3 mGal/degC, 3
///
/// The means explain the long record and the survey day of the publication (corrector/methods.md).
///
/// Accuracy (day_model_test.cpp): on a made-up day without placement and flicker, lags come out
/// within 1 % and gravity within 0.001 mGal.  With a placement of 1.2 mGal, the rms error of an
/// unknown station is below 1.6 mGal over 40 days, and 55 to 85 % are within the stated error.  The
/// fit has the same bits each time.  From nearby an unknown agrees within 0.005 mGal.
///
/// Cost: at most 2000 evaluations of the likelihood, each of which filters all bins and columns;
/// time is proportional to the number of bins.  Several threads may call it at a time.
/// @param record    record of the day, finite; each set-up has a bin.  Order: see above.
/// @param stations  one per set-up, in the record's numbering; stations are numbered from 0.
/// @param nearby    fit of a similar problem as start of the search, which is then faster; or null.
///                  It should have the same priors, because its point counts from them.
/// @param priors    priors of lags and terms.
/// @return std::nullopt if no set-up that is held has a bin.
/// Source: H. D. Patterson and R. Thompson, Biometrika 58, 545-554, 1971 (restricted likelihood);
/// C. E. Rasmussen and C. K. I. Williams, Gaussian Processes for Machine Learning, MIT Press 2006,
/// section 2.7 (explicit terms with priors).  Maximised by NLopt's Subplex (T. H. Rowan, thesis,
/// Austin 1990) or, from nearby, BOBYQA (M. J. D. Powell, report NA2009/06, Cambridge).
[[nodiscard]] std::optional<DayFit> fit_day(const reading::DayRecord& record,
                                            const std::vector<DayStation>& stations,
                                            const DayFit* nearby = nullptr,
                                            const DayPriors& priors = usual_day_priors());

/// Returns the fit to be expected of a day that is only planned, with a noise that is known.
///
/// The readings of the record are replaced by those that the priors' means give without noise.  An
/// unknown station has the gravity of the first that is held, so that the scale has no part in it.  Lags
/// and size of the axis biases are the medians of the priors.  Values are the priors' means; the
/// standard errors and their sources are those of a day with this noise.  noise_log_errors is absent.
///
/// Accuracy (day_model_test.cpp): if priors and noise are those that a day has found, the standard
/// errors agree with those of its fit within 0.1 %.
/// @param record  planned bins with their times and tilts; the readings are set.
/// @param stations, priors  as fit_day(); a value of gravity that is held matters for the scale only.
/// @param noise   each part > 0.
/// @return std::nullopt if no set-up that is held has a bin.
[[nodiscard]] std::optional<DayFit> fit_planned_day(reading::DayRecord& record,
                                                    const std::vector<DayStation>& stations,
                                                    const DayNoise& noise, const DayPriors& priors);

}  // namespace a351::corrector::whole_day
