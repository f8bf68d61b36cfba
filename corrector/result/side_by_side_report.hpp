#pragma once
/// @file
/// Comparison of the sensor with a reference gravimeter, in sentences, as a table and as JSON.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/result/column.hpp"

namespace a351::corrector::result {

/// Returns sentences on the comparison; none without reference gravimeters.
[[nodiscard]] std::vector<std::string> side_by_side_sentences(
    const model::SurveyCorrection& result);

/// Returns the columns of the compared stations.
[[nodiscard]] std::vector<Column<model::ComparedStation>> side_by_side_columns();

/// Returns the part `side_by_side` of result.json; null without reference gravimeters.
[[nodiscard]] nlohmann::ordered_json side_by_side_json(const model::SurveyCorrection& result);

}  // namespace a351::corrector::result
