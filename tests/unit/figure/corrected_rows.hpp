#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "tests/support/catch.hpp"

namespace a351::corrector::figure {

/// Returns made-up rows corrected by a linear model.
inline model::SurveyCorrection corrected(const std::vector<reading::SurveyRow>& rows,
                                         const std::string& model = "t") {
    return model::correct_survey(rows, {.model = model});
}

/// Returns how often a part occurs in a text.
inline std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

}  // namespace a351::corrector::figure
