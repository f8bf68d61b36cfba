#pragma once
/// @file
/// Reasons to doubt a row that need no gravity, and the studentised residual.  Both are reported;
/// neither removes a row from the fit.  Methods: corrector/methods.md, "Bad rows".
///
/// All functions are pure.

#include <optional>
#include <string>

#include "corrector/model/linear_fit.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::model {

/// Greatest rate of the temperature without doubt, degC/h.  Reason: at about 10 mGal/(degC/h), the
/// sensor's coefficient, it changes the reading by 2 mGal, the scatter of a reading.
inline constexpr double kGreatestRate_degc_per_h = 0.2;

/// Greatest range of a monotone or half-wave temperature without doubt, degC.  Reason: at about
/// 30 mGal/degC, the sensor's coefficient, it changes the reading by 1.5 mGal, which averaging over
/// the interval does not remove.
inline constexpr double kGreatestRange_degc = 0.05;

/// Returns the reasons to doubt a row because of its temperature, joined by `;`; empty if there are
/// none.
///
/// Reasons are |rate| above kGreatestRate_degc_per_h, and, if the row has a record, a temperature
/// that is monotone or half a wave with a range above kGreatestRange_degc.  A value equal to its
/// limit, or NaN, is no reason.  The text has the values, for example
/// `rate -0.201 degC/h;monotone over 0.060 degC`.
[[nodiscard]] std::string temperature_doubt(const reading::SurveyRow& row);

/// Returns the reasons to doubt a row without use of gravity, joined by `;`: temperature_doubt()
/// and the notes fallback and pulse.
///
/// Other notes of a row are no reasons here.
[[nodiscard]] std::string physical_doubt(const reading::SurveyRow& row);

/// Returns the external studentised residual t of a row: its residual divided by its standard
/// deviation, with the variance from the other rows only.
///
/// A row of the fit with leverage h: t = r / sqrt(s_i^2 (1 - h)), where
/// s_i^2 = (RSS - r^2 / (1 - h)) / (dof - 1).  Another row: t = r / sqrt(RSS / dof (1 + h)).
/// RSS includes the priors' rows.
///
/// The sign is that of the residual: t is positive if the reading is too low.  If the row is good
/// and the noise normal, t has Student's distribution: with dof - 1 degrees of freedom for a row of
/// the fit, with dof for another.
/// @param residual   reference - corrected, in the unit of the fit.
/// @param leverage   h of a row of the fit; for another row LinearFit::leverage_at() of it.
/// @param is_in_fit  true for a row of the fit.
/// @param fit        the fit.
/// @return std::nullopt if the fit has fewer than two degrees of freedom, if the variance is not
///         positive, or if a row of the fit has h > 1 - 1e-9.
/// Source: N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed., Wiley 1998, ch. 8.
[[nodiscard]] std::optional<double> studentised_residual(double residual, double leverage,
                                                         bool is_in_fit, const LinearFit& fit);

}  // namespace a351::corrector::model
