#pragma once
/// @file
/// The fits of a survey day by the whole-day model: of all rows in use, and without each station.
///
///     const DayFits fits = fit_with_and_without(problem, choice, priors);
///     fits.all.gravity_of(3);              // gravity of the station of row 3
///     if (const auto* other = fits.without("No.4")) other->gravity_of(3);  // its reference hidden

#include <string>
#include <vector>

#include "corrector/model/model.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector::model {

/// A fit and its stations, one per row.
struct Fitted {
    std::vector<whole_day::DayStation> stations;
    whole_day::DayFit fit;

    /// Returns gravity of the station of a row.
    [[nodiscard]] const whole_day::GravityEstimate& gravity_of(std::size_t row) const {
        return fit.gravity_mgal[stations[row].number];
    }
};

/// The fit of one set of rows, and the fits without each station.
struct DayFits {
    Fitted all;                         ///< Fit of all rows in use.
    std::vector<std::string> left_out;  ///< Names of the stations left out in turn.
    std::vector<Fitted> others;         ///< Fits without each station of `left_out`.

    /// Returns the fit without a station; null if it is not left out.
    [[nodiscard]] const Fitted* without(const std::string& site) const;
    /// Returns the fit in which the reference of a row's station is not held: `all`, or the one
    /// without it; null if the station alone is held.
    /// @param row, site  number of the row, name of its site.
    [[nodiscard]] const Fitted* with_unknown(std::size_t row, const std::string& site) const;
};

/// Fits a day whose rows day_refusal() accepts.
///
/// Held are the references of the rows in use.  Every station has a number in the order of its first
/// row, and so has every row that is not accepted; the numbers of all fits are the same.
[[nodiscard]] DayFits fit_with_and_without(const SurveyProblem& problem, const RowChoice& choice,
                                           const whole_day::DayPriors& priors);

}  // namespace a351::corrector::model
