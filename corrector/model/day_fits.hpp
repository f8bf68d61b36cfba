#pragma once
/// @file
/// The fits of a survey day by the whole-day model, of all rows in use and without each station, and
/// what follows from them for the stations.
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

/// Returns the stations of a fit, one per row.  Held is the reference of rows in use, except those of
/// the station `left_out`.
///
/// Every station has a number in the order of its first row, and so has every row that is not
/// accepted.
[[nodiscard]] std::vector<whole_day::DayStation> stations_of(const SurveyProblem& problem,
                                                             const RowChoice& choice,
                                                             const std::string& left_out = "");

/// Fits a day whose rows day_refusal() accepts.
///
/// Held are the references of the rows in use.  The numbers of the stations are the same in all fits.
[[nodiscard]] DayFits fit_with_and_without(const SurveyProblem& problem, const RowChoice& choice,
                                           const whole_day::DayPriors& priors);

/// Sets stations, differences and covariance of the fit of a day.
///
/// A station's value is the mean of its corrected rows; its uncertainty is that of its gravity as if
/// the reference were unknown.  Degrees of freedom are those of Welch and Satterthwaite, nu =
/// u^4 / sum(u_k^4 / nu_k), over placement, flicker and white noise with nu_k = 1 / (2 e_k^2), where
/// e_k is the standard error of ln(standard deviation); the other parts come from priors, with
/// infinite nu.  The coverage factor is 2, because u contains the expected variances of the noise,
/// which are larger than the most likely ones (few_datums.py measures the coverage).
///
/// The covariance is the correlation of the errors with the own reference hidden
/// (whole_day::StationSystem), times the uncertainties.
///
/// Source: JCGM 100:2008, G.4.1 (degrees of freedom), 5.1.2 (contributions).
/// @param result  with corrected rows.
void set_day_stations(Fit& result, const SurveyProblem& problem, const RowChoice& choice,
                      const DayFits& fits, const whole_day::DayPriors& priors);

/// Multiplies the uncertainties of stations and differences by a factor.  Those of readings remain,
/// so that a reading that is far off still looks so.
void enlarge_uncertainties(Fit& result, double factor);

}  // namespace a351::corrector::model
