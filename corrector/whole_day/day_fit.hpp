#pragma once
/// @file
/// Results of an adjustment of survey days: gravities with the sources of their errors, coefficients of a
/// survey, its set-ups.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_priors.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::whole_day {

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

/// The gravity of a station, estimated or held.
struct GravityEstimate : Estimate {
    /// Contributions of the sources to the standard error, mGal; the sum of their squares is its
    /// square (JCGM 100:2008, 5.1.2).  All 0 if an exact reference is held.
    std::array<double, kErrorSources> parts_mgal{};
    /// Contributions of the unit's parameters, whose priors several days of one unit have in common:
    /// how the estimate answers to one deviation of each of unit_parameters(), then of k, mGal.  All 0
    /// if an exact reference is held.  Each day decides the size of oA and oS, so that they are not
    /// among them.
    std::vector<double> shared_mgal;
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

/// Places in SurveyPoint.  The lags are also places in DayPriors.
enum DayHyper : std::size_t {
    kFastLag,
    kSlowLag,
    kPlacement,
    kFlicker,
    kWhite,
    kBiasSize,
    kOuterLag,
    kOuterSize,
    kScaleShare
};
/// Both lags, placement, flicker, white noise, size of the axis biases, lag and size of the outer oven's
/// effect, share of the errors in the scale: deviations from their priors in standard deviations; 0: medians
/// of the priors.  Those of an outer oven and of the scale are 0 without an outer oven and in one face.
using SurveyPoint = std::array<double, 9>;

/// One survey of an adjustment: coefficients, noise, set-ups.
struct DayFit {
    SurveyPoint point{};  ///< Most likely.
    /// The same with the roots of the expected variances (day_search.hpp).
    SurveyPoint expected{};
    DayNoise noise;                                ///< Most likely noise.
    DayNoise expected_noise;                       ///< Roots of the expected variances.
    double fast_lag_s = 0.0, slow_lag_s = 0.0;     ///< tF, tS.
    std::array<double, 2> lag_log_errors{};        ///< Standard errors of ln tF and ln tS.
    std::array<Estimate, kDayTerms> coefficients;  ///< Errors include those of the lags.
    std::vector<Estimate> steps_mgal;              ///< Offsets of the steps, in order of time.
    std::optional<OuterResponse> outer;            ///< Absent without an outer oven.
    /// Share of the errors that act on the scale; absent if the sensor was not turned over.
    std::optional<Estimate> scale_share;
    /// Parts of rA, rS, rF, d and w that act on the scale; empty if the sensor was not turned over.
    std::vector<Estimate> on_scale;
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

}  // namespace a351::corrector::whole_day
