#pragma once
/// @file
/// Reasons to doubt a row that need no gravity.  They are reported; no row is left out because of
/// them.  Methods: corrector/methods.md, "Bad rows".
///
/// All functions are pure.

#include <string>

#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::judgement {

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

}  // namespace a351::corrector::judgement
