#pragma once
/// @file
/// The stations of a day fitted by the whole-day model: their values, differences and errors.

#include "corrector/model/day_fits.hpp"

namespace a351::corrector::model {

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

}  // namespace a351::corrector::model
