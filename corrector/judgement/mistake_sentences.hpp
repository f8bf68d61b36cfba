#pragma once
/// @file
/// A mistake in words, with the amendment that puts it right.

#include <vector>

#include "corrector/judgement/mistake_search.hpp"
#include "corrector/model/model.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/survey_row.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::judgement {

/// Returns the findings about a mistake: one, or two for swapped names.
///
/// If a stay is off, another site is proposed whose reference is within two and a half standard
/// uncertainties of the reading.  There is no amendment for rows without ListedSetUp::site.
/// @param readings, rows, choice  all readings of the search, and those of its fit.
/// @param sites  sites whose name may be right.
[[nodiscard]] std::vector<reading::Finding> findings_of(
    const Mistake& mistake, const std::vector<SearchedReading>& readings,
    const std::vector<reading::SurveyRow>& rows, const model::RowChoice& choice,
    const std::vector<text::Site>& sites);

}  // namespace a351::corrector::judgement
