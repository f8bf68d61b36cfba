#pragma once
/// @file
/// A survey with alternatives put right, as amendments of a person would do it.

#include <vector>

#include "corrector/adjustment/trials.hpp"
#include "corrector/model/model.hpp"

namespace a351::corrector::model {

/// A survey with mistakes put right.
struct AmendedSurvey {
    std::vector<reading::SurveyRow> rows;
    SurveyOptions options;
    RowChoice choice;
};

/// Puts alternatives right: a set-up or a stay that is off is excluded, the reference of a station is
/// refused, names are exchanged, and a step is an unknown.
[[nodiscard]] AmendedSurvey amended(const std::vector<reading::SurveyRow>& rows,
                                    const SurveyOptions& options,
                                    const std::vector<adjustment::Alternative>& alternatives);

/// Returns the number of the reading of the same instrument before a reading, which there must be.
[[nodiscard]] std::size_t reading_before(const std::vector<reading::SurveyRow>& rows,
                                         std::size_t after);

/// Returns the instant between a reading and the one of the same instrument before it: that of a step.
[[nodiscard]] UtcTime time_before(const std::vector<reading::SurveyRow>& rows, std::size_t after);

}  // namespace a351::corrector::model
