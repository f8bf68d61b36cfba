#pragma once
/// @file
/// A survey corrected with what is known of its unit (corrector/methods.md, "Calibration").

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector {

/// Readings that differ so much from the calibration by chance once in a hundred contradict it.
inline constexpr double kContradictionP = 0.01;

/// Whether it has axis biases or a thermal response; a time to warm up is of no use to a day.
[[nodiscard]] bool says_of_day(const std::optional<Calibration>& calibration);

/// The usual priors and what the calibration adds to them.
[[nodiscard]] DayPriors day_priors_of(const std::optional<Calibration>& calibration);

/// How far the day moved some of lags and terms from their priors, against how far it may have.
/// @param places  in DayPriors; a block whose priors are independent of the others.
/// @return std::nullopt when the day says nothing about them.
[[nodiscard]] std::optional<Disagreement> disagreement(const DayFit& fit,
                                                       const std::vector<Eigen::Index>& places);

/// A day that comes out worse with a calibration by more than this, each station left out, is told.
/// A unit's own thermal calibration changed it by -2.0 to +2.5 % (methods.md, 8101-8120); its own axis
/// biases made two of those 20 days worse by more, and such days are told too.
inline constexpr double kHarm = 0.03;

/// Says what the calibration did as prior of the whole-day model: SurveyCorrection::calibration.
/// @param fit  with day_priors_of(); rows and score of `result` are corrected.
/// @param without, without_loso_mgal  by the usual priors.
void tell_prior_use(SurveyCorrection& result, const DayFit& fit, const DayFit& without,
                    const std::optional<double>& without_loso_mgal);

/// correct_survey(), and where it is by another model than the whole-day one, readings are first
/// freed from what tilt makes of the calibration's axis biases.
[[nodiscard]] SurveyCorrection correct_with_calibration(const std::vector<SurveyRow>& rows,
                                                        const SurveyOptions& options,
                                                        const DayRecord* day);

/// What a score has of the calibration: "prior", "fixed" (readings freed from axis bias x tilt), "none".
[[nodiscard]] std::string_view calibration_in(const SurveyCorrection& result,
                                              const ModelScore& score);

/// null without a calibration.
[[nodiscard]] nlohmann::ordered_json calibration_json(const SurveyCorrection& result);

}  // namespace a351::corrector
