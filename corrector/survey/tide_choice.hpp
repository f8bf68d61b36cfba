#pragma once

#include <string>
#include <vector>

#include "corrector/survey/survey_row.hpp"

namespace a351::corrector {

/// Where the tide of a survey comes from.
struct TideChoice {
    std::string source = "direct";  ///< given (of the table), direct = catalogue, longman, none.
    TideFactors factors;            ///< Not for `given`.
};

[[nodiscard]] const std::vector<std::string>& tide_sources();

/// The computed model behind a source other than `given`.
/// @throws InputError  unknown source; names those allowed.
[[nodiscard]] TideModel tide_model(const std::string& source);

/// Sets the tide of every row.
/// @throws InputError  unknown source, a row without a given tide.
void apply_tide(std::vector<SurveyRow>& rows, const std::vector<text::Site>& sites,
                const TideChoice& choice);

}  // namespace a351::corrector
