#pragma once
/// @file
/// Finds what is wrong with a corrected survey, and says it with a proposal for each.
///
///     const SurveyCorrection result = correct_and_search({rows, sites, day}, options);
///     result.findings;

#include <cstddef>
#include <functional>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/survey_row.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::judgement {

/// The survey that was corrected.
struct SearchedSurvey {
    const std::vector<reading::SurveyRow>& rows;  ///< As they were corrected.
    const std::vector<text::Site>& sites;
    const reading::DayRecord* day;  ///< Null: there are only averages.
    /// Called before each trial of the search with the trials done and those expected.
    std::function<void(std::size_t done, std::size_t total)> progress = {};
};

/// Searches a corrected survey for mistakes (mistake_search.hpp), with the model that was applied.
///
/// If a reading is off by the difference between two references of the list, within two and a half
/// standard uncertainties, the other site is proposed.  `paper` is not searched.
/// Remarks are added about a base with one stay, and benchmarks that were not visited.
/// @param result  with the findings that are known already, for example moved boxes.
/// @return these and the new ones, the worst first: an unusable day, headlines, other mistakes,
///         remarks, benchmarks that were not visited.
[[nodiscard]] std::vector<reading::Finding> find_mistakes(const model::SurveyCorrection& result,
                                                          const SearchedSurvey& survey);

/// Corrects a survey and searches it.  If `auto` did not take the whole-day model, mistakes are
/// searched with that model too.  If one is found, the model is chosen again from the readings
/// without the mistakes.
/// @param known  findings that are known already.
/// @throws InputError  as model::correct_survey().
[[nodiscard]] model::SurveyCorrection correct_and_search(
    const SearchedSurvey& survey, model::SurveyOptions options,
    const std::vector<reading::Finding>& known = {});

/// Fewest stations from which the leave-one-station-out error says something.  Reason: the rms of
/// five errors is known to a third, that of two to a half.
inline constexpr std::size_t kFewestLeftOut = 5;

/// Returns left_out - reference of each station whose reference the fit uses and that can be left
/// out, mGal: errors as of new stations.
[[nodiscard]] std::vector<double> new_station_errors_mgal(const model::SurveyCorrection& result);

}  // namespace a351::corrector::judgement
