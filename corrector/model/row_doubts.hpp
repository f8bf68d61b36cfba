#pragma once
/// @file
/// Doubts about the rows of a fit.  No row is left out because of them.
///
/// A model calls one of the functions doubt_...() after its rows are corrected.  They set
/// CorrectedRow::doubt_statistical, for example to `t -4.83 over 3.56`: the studentised residual
/// and its limit.  The sign is that of reference - corrected.
///
/// Use doubt_in_turn() where a bad row changes the fit of all others.  Use doubt_by_prediction()
/// where each residual comes from a fit without the row's station.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {

/// Distance from the temperatures of the fit that is not worth a remark, degC.  Reason: it is twice
/// the swing of the oven, and 1.5 mGal at the published -29 mGal/degC.
inline constexpr double kOutsideTemperature_degc = 0.05;

/// Residuals of a fit to some rows.
struct StudentisedRows {
    /// (n) Studentised residuals of all rows, in use or not; absent: undefined, never doubted.
    std::vector<std::optional<double>> values;
    std::size_t dof = 0;  ///< Degrees of freedom of the fit.
};

/// Fits some of the rows again; std::nullopt if they do not determine the fit.
///
/// It gets all rows (n), and for each (n) whether it is in use.  It must return n values.
using Refit = std::function<std::optional<StudentisedRows>(
    const std::vector<reading::SurveyRow>& rows, const std::vector<bool>& in_use)>;

/// Sets doubt_statistical by a search for one bad row after another.
///
/// The row in use with the largest |t| is removed if its |t| is above studentised_limit() with
/// dof - 1, and the rest is fitted again, until no such row is left.
/// Then rows that were not in use from the start are
/// tested against the last fit, with dof.  The search ends early if a fit is undetermined or has
/// fewer than two degrees of freedom; the doubts found until then remain.  Two bad rows of equal
/// size may hide each other.
///
/// Cost: one fit, and another for each row that is doubted.  At the limit itself there is no doubt.
/// @param rows   rows of the fit; doubt_statistical is set, and not cleared where there is none.
/// @param refit  called at least once, with the rows and those that are left in use.
void doubt_in_turn(std::vector<CorrectedRow>& rows, const Refit& refit);

/// Calls doubt_in_turn() with the least-squares fit of a linear model.
///
/// Rows without a reference are not tested.
/// @param rows    (n), at least one, all rows of the survey.
/// @param model   model of the fit.
/// @param origin, priors  as in the fit.
void doubt_by_linear_fit(std::vector<CorrectedRow>& rows, const LinearModel& model,
                         const TimeOrigin& origin, const Priors& priors);

/// Sets doubt_statistical where the studentised residual of the prediction without the row's
/// station is above studentised_limit() with the degrees of freedom of the station.  Here one bad row
/// does not hide another, so no row is removed.
///
/// Rows of a station without degrees of freedom are not tested.
/// @param result  with score, stations and studentised residuals; its rows are changed.
void doubt_by_prediction(Fit& result);

/// Returns the doubtful rows with their reasons, one per line, or a line that there are none.
///
/// Both kinds of doubt are listed, in the order of the rows.  The text ends with a newline.
/// @param result  with doubts set, as correct_survey() returns it.
[[nodiscard]] std::string doubts_text(const SurveyCorrection& result);

/// Returns a remark on readings of unknown stations whose temperature is outside that of the
/// readings in the fit at known stations, by more than kOutsideTemperature_degc; empty if there are
/// none, or if the rows have no temperature.
///
/// The temperature correction of such a reading is extrapolated: an error of the coefficient acts
/// on the whole distance.
/// @param rows   rows of the fit.
/// @param datum  stations whose reference is held; empty: all.
[[nodiscard]] text::Message temperature_remark(const std::vector<CorrectedRow>& rows,
                                               const std::vector<std::string>& datum);

}  // namespace a351::corrector::model
