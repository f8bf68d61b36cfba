#pragma once
/// @file
/// Sentences about the equations of a network that cannot be solved, and about an adjusted network.

#include <optional>

#include "corrector/adjustment/survey_equations.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/model/network.hpp"
#include "corrector/model/refusal.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {

/// Returns why the equations cannot be solved, without looking at the times.
[[nodiscard]] std::optional<Refusal> refusal_of(const adjustment::SurveyEquations& survey);

/// Returns why these unknowns are undetermined, and what would help.
[[nodiscard]] Refusal undetermined(const adjustment::AdjustedSurvey& adjusted);

/// Adds the remarks on an adjusted network: its loops, stations tied by drift only, and uncontrolled
/// readings.
void add_remarks(NetworkResult& result);

/// Returns the fitted admittance in words.  The sentence also says whether the readings can
/// distinguish it from gravity.
[[nodiscard]] text::Message admittance_remark(const Fit& result);

}  // namespace a351::corrector::model
