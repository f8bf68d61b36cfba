#pragma once
/// @file
/// A survey day adjusted by the whole-day model: values of rows and stations with and without their own
/// reference.
///
///     const AdjustedDay day = adjusted_day(problem, choice, priors);
///     day.without(3)->gravity;      // of the station of row 3, as if its reference were unknown

#include <memory>
#include <optional>
#include <vector>

#include "corrector/model/model.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector::model {

/// A day and its adjustment, and adjustments in which the reference of one station is hidden.
class AdjustedDay {
public:
    using Adjustment = std::shared_ptr<const whole_day::DayAdjustment>;
    /// A station whose reference is not held.
    struct Without {
        Adjustment adjustment;  ///< The day's, or one searched again without it.
        whole_day::GravityEstimate gravity;
    };

    AdjustedDay(whole_day::DaySurvey survey, const Adjustment& adjustment);

    [[nodiscard]] const whole_day::DaySurvey& survey() const { return survey_; }
    [[nodiscard]] const whole_day::DayAdjustment& adjustment() const { return *adjustment_; }
    [[nodiscard]] const whole_day::DayFit& fit() const { return fit_; }
    [[nodiscard]] std::size_t number_of(std::size_t row) const {
        return survey_.stations[row].number;
    }
    /// Returns true if two references or more are held, so that each can be hidden.
    [[nodiscard]] bool is_any_left_out() const { return held_count_ > 1; }
    /// Returns the station of a row without its reference; null if it alone is held.
    [[nodiscard]] const Without* without(std::size_t row) const;

private:
    whole_day::DaySurvey survey_;
    Adjustment adjustment_;
    whole_day::DayFit fit_;
    std::size_t held_count_ = 0;
    std::vector<Without> without_;  ///< One of each number.
};

/// Returns a survey for the whole-day model, one set-up per row.  Held are the references of the rows in
/// use.
///
/// Every station has a number in the order of its first row, and so has every row that is not
/// accepted.
[[nodiscard]] whole_day::DaySurvey day_survey(const SurveyProblem& problem, const RowChoice& choice,
                                              const whole_day::DayPriors& priors);

/// Adjusts a day whose rows day_refusal() accepts.
[[nodiscard]] AdjustedDay adjusted_day(const SurveyProblem& problem, const RowChoice& choice,
                                       const whole_day::DayPriors& priors);

/// Returns the coefficients of a survey: terms, steps, lags, response to an outer oven, noise.
/// @param scope  only those of the unit, or of the survey; absent: all.
[[nodiscard]] std::vector<Coefficient> coefficients_of(
    const whole_day::DayFit& fit, std::optional<adjustment::Scope> scope = std::nullopt);

/// Sets stations, differences and covariance of the fit of a day.
///
/// A station's value is the mean of its corrected rows; its uncertainty is that of its gravity as
/// if the reference were unknown.  Degrees of freedom are those of Welch and Satterthwaite: nu =
/// u^4 / sum(u_k^4 / nu_k), over placement, flicker and white noise, with nu_k = 1 / (2 e_k^2).
/// e_k is the standard error of ln(standard deviation).  The other parts come from priors, with
/// infinite nu.  The coverage factor is 2, because u contains the expected variances of the noise,
/// which are larger than the most likely ones (few_datums.py measures the coverage).
///
/// The covariance is the correlation of the errors with the own reference hidden
/// (whole_day::DayAdjustment), times the uncertainties.
///
/// Source: JCGM 100:2008, G.4.1 (degrees of freedom), 5.1.2 (contributions).
/// @param result  with corrected rows.
void set_day_stations(Fit& result, const SurveyProblem& problem, const RowChoice& choice,
                      const AdjustedDay& day);

/// Multiplies the uncertainties of stations and differences by a factor.  Those of readings remain,
/// so that a reading that is far off still looks so.
void enlarge_uncertainties(Fit& result, double factor);

}  // namespace a351::corrector::model
