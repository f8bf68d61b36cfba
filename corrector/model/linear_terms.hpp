#pragma once
/// @file
/// Terms that a linear model can have besides the constant and the steps.

#include <string_view>
#include <vector>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::model {

/// A term: its coefficient times its column is an effect in mGal, which is subtracted from the
/// reading.
struct LinearTerm {
    bool LinearModel::*is_in;  ///< Member of a model that says whether it has the term.
    std::string_view name;     ///< Name of the coefficient, with its unit.
    /// Returns the term's column for a row.
    /// @throws InputError  if the row lacks what the term needs.
    double (*column)(const LinearModel& model, const reading::SurveyRow& row,
                     const TimeOrigin& origin);
    /// Adds the effect to the correction that it belongs to.
    void (*correct)(CorrectedRow& row, MilliGal effect);
};

/// Returns the terms of a model, in the order of its columns; the scale is the last one.
[[nodiscard]] std::vector<LinearTerm> terms_of(const LinearModel& model);

}  // namespace a351::corrector::model
