#pragma once
/// @file
/// Correction of a survey with the calibration of its unit (corrector/methods.md, "Calibration").

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector {

/// Probability below which the readings contradict the calibration: such a difference occurs by
/// chance once in a hundred surveys.
inline constexpr double kContradictionP = 0.01;

/// Returns true if the calibration has axis biases or a thermal response.  A warm-up time alone
/// does not help to correct a day.
[[nodiscard]] bool helps_to_correct_day(const std::optional<Calibration>& calibration);

/// Returns the usual priors, combined with the calibration: axis biases with their covariance, the
/// thermal response with kThermalErrorFactor^2 times its covariance.
[[nodiscard]] DayPriors day_priors_of(const std::optional<Calibration>& calibration);

/// Tests how far the day moved some lags and terms from their priors.
///
/// With the shift s in units in which the priors are independent and of variance 1, and its
/// posterior covariance V, s has the covariance D = 1 - V if the prior is true.  chi-square = s^T
/// D^-1 s over the directions in which D is above 1e-10 (terms) or 1e-4 (lags); dof is their
/// number.
/// @param fit     fit with these priors.
/// @param places  places in DayPriors; their priors must be independent of those of other places.
/// @return std::nullopt if the day contains no information about them (dof = 0).
[[nodiscard]] std::optional<Disagreement> disagreement(const DayFit& fit,
                                                       const std::vector<Eigen::Index>& places);

/// Relative increase of the leave-one-station-out error above which the calibration is reported as
/// harmful.  Source: a unit's own thermal calibration changed this error by -2.0 to +2.5 %
/// (methods.md, 8101-8120).  Its own axis biases made two of those 20 days worse by more; such days
/// are reported too.
inline constexpr double kHarm = 0.03;

/// Sets SurveyCorrection::calibration and adds remarks on the calibration as prior of the whole-day
/// model.
/// @param result             survey with corrected rows and score; its options have a calibration.
/// @param fit                fit with day_priors_of().
/// @param without            fit of the same rows with the usual priors.
/// @param without_loso_mgal  LOSO with the usual priors; absent if there is none.
void report_prior_use(SurveyCorrection& result, const DayFit& fit, const DayFit& without,
                      const std::optional<double>& without_loso_mgal);

/// Corrects a survey with the calibration of the options, if there is one.
///
/// The whole-day model takes the calibration as prior.  For all other models bx x + by y is
/// subtracted from the readings before the fit and shown as tilt correction; the uncertainty of the
/// biases is neglected, and the thermal response is not used.
/// @param rows, options, day  as correct_survey().
/// @throws InputError  as correct_survey(), and if there are axis biases and a row has no means of
///                     the axes.
[[nodiscard]] SurveyCorrection correct_with_calibration(const std::vector<SurveyRow>& rows,
                                                        const SurveyOptions& options,
                                                        const DayRecord* day);

/// Returns the use of the calibration in a score: "prior", "fixed" (axis bias x tilt was subtracted
/// from the readings) or "none".
[[nodiscard]] std::string_view calibration_in(const SurveyCorrection& result,
                                              const ModelScore& score);

/// Returns the part `calibration` of result.json; null without a calibration.
[[nodiscard]] nlohmann::ordered_json calibration_json(const SurveyCorrection& result);

}  // namespace a351::corrector
