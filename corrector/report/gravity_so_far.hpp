#pragma once
/// @file
/// Gravity so far: one JSON document about the stays of a day that is still being recorded.  The
/// daemon shows it; its members are in corrector/result/table-format.md, "Gravity so far".

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/occupation_rows.hpp"
#include "corrector/reading/refused.hpp"

namespace a351::corrector::report {

/// Knowledge of a day so far.  Each part is absent as long as it cannot be computed.
struct GravitySoFar {
    std::optional<UtcTime> as_of;  ///< Newest clock reading of the journal.
    std::optional<reading::OccupationRows> read;
    std::optional<model::SurveyCorrection> result;
    std::optional<MilliGal> u_evening;  ///< design::u_in_the_evening() for the running stay.
    std::string reason;       ///< Code of reading::Refused; empty with a result.
    std::string reason_text;  ///< The same in words.
};

/// Returns a refusal in one sentence for the operator.
[[nodiscard]] std::string in_words(const reading::Refused& refused);

/// Returns the document.  Each stay has one element, in order of time, those without a value too.
///
/// - gravity_mgal: mean of the corrected values of its set-ups; of a known station without its own
///   reference.
/// - u_mgal: standard uncertainty of this mean as if the station were unknown; of the running stay with
///   `u_evening` for that of its station.
///   While something contradicts it is larger: judgement::doubt_factor(), and the difference from the
///   reference of a stay that is named.
/// - missing_parts: what is needed before gravity is known; null if it is.
/// - left_out_difference_mgal: value without the station's reference, minus the reference.
/// - contradictions, lesser_contradictions: judgement::contradictions().
/// - remarks: the reasons of its grade (reading_grade.hpp), or why it has no value.
[[nodiscard]] nlohmann::ordered_json to_json(const GravitySoFar& so_far);

}  // namespace a351::corrector::report
