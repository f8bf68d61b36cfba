#pragma once
/// @file
/// Correction of a survey with the calibration of its unit (corrector/methods.md, "Calibration").
///
/// For rows from records call correct_with_calibration() in place of correct_survey(), also without
/// a calibration, and write calibration_json() to the result.  The other functions are for the
/// whole-day model and for tables.
///
///     options.calibration = read_calibration("calibration.toml");
///     const SurveyCorrection result = correct_with_calibration(rows, options, day);
///     const auto json = calibration_json(result);
///
/// Serial number and validity are not compared with the survey here; check_calibration()
/// (corrector/job) does that.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/whole_day/day_fit.hpp"

namespace a351::corrector::model {

/// Probability below which the readings contradict the calibration: such a difference occurs by
/// chance once in a hundred surveys.
inline constexpr double kContradictionP = 0.01;

/// Returns true if the calibration has axis biases, a thermal response or a placement.  A warm-up time
/// alone does not help to correct a day.
[[nodiscard]] bool helps_to_correct_day(const std::optional<unit::Calibration>& calibration);

/// Returns the usual priors, combined with the calibration: axis biases with their covariance, the
/// thermal response with kThermalErrorFactor^2 times its covariance.  A placement replaces the usual
/// prior, which it contains.
///
/// The result is narrower than either: for a single coefficient the inverse variances add up.
/// Without a calibration it is usual_day_priors().
/// @throws std::invalid_argument  as DayPriors::observe().
[[nodiscard]] whole_day::DayPriors day_priors_of(
    const std::optional<unit::Calibration>& calibration);

/// Returns the same for a survey: a prior of the scale in its options replaces that of the calibration.
[[nodiscard]] whole_day::DayPriors day_priors_of(const SurveyOptions& options);

/// Tests how far the day moved some lags and terms from their priors.
///
/// Let s be the shift, in units in which the priors are independent and of variance 1, and V its
/// posterior covariance.  If the prior is true, s has the covariance D = 1 - V.  chi-square = s^T
/// D^-1 s over the directions in which D is above 1e-10 (terms) or 1e-4 (lags).  dof is the number
/// of these directions.
///
/// If the prior is true, the p of a part is below kContradictionP on one day in a hundred.  A prior
/// that is wrong is found also if its stated errors are much too small (calibration_use_test.cpp:
/// axis biases wrong by 5000 mGal/g, with variances down to 0.01).
/// @param fit     fit with these priors.
/// @param places  places in DayPriors; their priors must be independent of those of other places.
/// @return std::nullopt if the day contains no information about them (dof = 0).
[[nodiscard]] std::optional<Disagreement> disagreement(const whole_day::DayFit& fit,
                                                       const std::vector<Eigen::Index>& places);

/// Relative increase of the leave-one-station-out error above which the calibration is reported as
/// harmful.  Source: a unit's own thermal calibration changed this error by -2.0 to +2.5 %
/// (accuracy.md, 8101-8120).  Its own axis biases made two of those 20 days worse by more; such days
/// are reported too.
inline constexpr double kHarm = 0.03;

/// Sets Fit::calibration and adds remarks on the calibration as prior of the whole-day model.
///
/// There is always one remark on the use and its effect.  Others follow if a part is contradicted,
/// if it could not be tested, or if LOSO is worse by more than kHarm.
/// @param result             fit with corrected rows and score.
/// @param calibration        calibration of the unit.
/// @param fit                fit with day_priors_of().
/// @param without            fit of the same rows with the usual priors.
/// @param without_loso_mgal  LOSO with the usual priors; absent if there is none.
void report_prior_use(Fit& result, const unit::Calibration& calibration,
                      const whole_day::DayFit& fit, const whole_day::DayFit& without,
                      const std::optional<double>& without_loso_mgal);

/// Returns the rows with bx x + by y of the calibration subtracted from the readings; the rows as they
/// are without a calibration or without its axis biases.
/// @throws InputError  there are axis biases and a row has no means of the axes.
[[nodiscard]] std::vector<reading::SurveyRow> without_known_tilt(
    std::vector<reading::SurveyRow> rows, const std::optional<unit::Calibration>& calibration);

/// Corrects a survey with the calibration of the options, if there is one.
///
/// The whole-day model takes the calibration as prior.  For all other models bx x + by y is
/// subtracted from the readings before the fit and shown as tilt correction; the uncertainty of the
/// biases is neglected, and the thermal response is not used.
///
/// The accelerations of the result are those before the subtraction, and the corrections still add
/// up to the corrected value (calibration_use_test.cpp).  The scores of the models that were not
/// applied are made from readings after the subtraction, also if `day` is applied.
/// @param rows, options, day  as correct_survey().
/// @throws InputError  as correct_survey(), and if there are axis biases and a row has no means of
///                     the axes.
[[nodiscard]] SurveyCorrection correct_with_calibration(const std::vector<reading::SurveyRow>& rows,
                                                        const SurveyOptions& options,
                                                        const reading::DayRecord* day);

/// Returns the use of the calibration in a score: "prior", "fixed" (axis bias x tilt was subtracted
/// from the readings) or "none".
/// @param result  result of correct_with_calibration().
/// @param score   one of its scores.
[[nodiscard]] std::string_view calibration_in(const SurveyCorrection& result, const Score& score);

/// Returns the part `calibration` of result.json; null without a calibration.
///
/// It has the unit, the validity, the use and test of both parts, and the effect.  Values that are
/// not defined are null: tests of fixed biases, and the comparison without LOSO.
/// @param result  result of correct_with_calibration().
[[nodiscard]] nlohmann::ordered_json calibration_json(const SurveyCorrection& result);

}  // namespace a351::corrector::model
