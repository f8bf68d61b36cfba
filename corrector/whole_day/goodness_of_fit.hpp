#pragma once
/// @file
/// Tests whether the whole-day model fits a day.
///
///     for (const FitTest& test : goodness_of_fit(survey, fit))
///         if (test.is_misfit()) warn(test.misfit, test.p);
///
/// The means of the set-ups scatter about the model with a known covariance: that of the noise and of
/// the priors.  What the model lacks shows in them:
/// - curvature: a course with the square of the temperature or of the time, for example a response
///   that is not linear;
/// - step: all readings from one set-up on are higher or lower;
/// - tails: a quarter of the set-ups has most of the scatter, so placement is not normal.
///
/// A statistic is a share of squares, 0 to 1:
///
///     curvature, step:  largest t^2 / (t^2 + s) over all directions
///     tails:            1 - s' / s0, with a quarter of the set-ups taken away, worst first
///
/// t is the part of the whitened residuals in the direction of the misfit, s the scatter of the
/// readings without it, s0 the scatter with it, s' that without the quarter.  The size of the noise
/// has therefore little effect; lags and the sizes of the noise relative to each other and to the
/// priors are those of the fit.  The probability of a statistic is counted in 2000 simulations of the
/// same day without a misfit, with the same draws each time: p is 1/2001 at least.

#include <array>
#include <string_view>
#include <vector>

#include "corrector/whole_day/day_fit.hpp"
#include "corrector/whole_day/day_survey.hpp"

namespace a351::corrector::whole_day {

/// Kind of misfit that a test finds.
enum class Misfit { curvature, step, tails };

/// Names of the tests in result.json.
inline constexpr std::array<std::string_view, 3> kMisfitNames{"curvature", "step", "tails"};

/// Probabilities below which a test counts as a misfit.  Reason: at most 5 % of ordinary days may have
/// a finding, and the search for mistakes has one on 2 to 3 %.  The level of the tails is the smallest,
/// because ordinary days are below it several times as often as it says (accuracy.md).
inline constexpr std::array<double, 3> kMisfitProbabilities{0.013, 0.015, 0.002};

/// A test of the fit.
struct FitTest {
    Misfit misfit{};
    double p = 1.0;  ///< Probability of at least this statistic on a day that the model fits.
    /// curvature: 0 of the temperature, 1 of the time; step: first set-up after it; tails: the
    /// set-up that fits worst.
    std::size_t place = 0;

    /// Returns true if the model does not fit the day.
    [[nodiscard]] bool is_misfit() const {
        return p < kMisfitProbabilities.at(static_cast<std::size_t>(misfit));
    }
};

/// Least number of degrees of freedom of the tests: set-ups minus unknown stations minus 1.
/// Reason: with fewer, a curve and a step leave nothing to compare them with.
inline constexpr int kFewestFitDof = 5;

/// Tests a fit.
///
/// Accuracy: a probability of 1 % has a standard error of 0.2 %.  Error rates on simulated days:
/// tests/bench/misfits.py.  goodness_of_fit_test.cpp: on ten ordinary days with five times the
/// usual noise at most 2 of 30 tests name a misfit.  One day each: a step of 15 mGal is found at
/// its set-up, a response of 150 mGal/degC^2 as curvature of the temperature, and of three set-ups
/// that are off by 14, 15 and -17 mGal the last is named.
/// @param fit  of the survey.
/// @return one test of each kind; none with fewer than kFewestFitDof degrees of freedom.
/// Source: B. D. Ripley, Stochastic Simulation, Wiley 1987, section 7.1 (Monte Carlo tests).
[[nodiscard]] std::vector<FitTest> goodness_of_fit(const DaySurvey& survey, const DayFit& fit);

}  // namespace a351::corrector::whole_day
