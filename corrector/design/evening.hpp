#pragma once
/// @file
/// The uncertainty that a running stay will have in the evening.
///
///     const auto u = u_in_the_evening(result, sites, running_key);   // while the box still stands

#include <optional>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::design {

/// Returns the standard uncertainty, mGal, that a stay will have after a return to the base.  The base
/// is the first visited station with a reference.
///
/// It is the present uncertainty of the station, times the ratio of the expected ones with and
/// without one more visit of the base.  That visit comes after the median of the day's drives.  It
/// has the set-ups of the running stay.  The expected uncertainties are those of expected_errors()
/// for the visits so far, with the priors of the correction and the noise that the day shows.
///
/// Absent in these cases: another model than `day` corrects the day; the stay has no reading; its
/// station has a reference; no station with a reference was visited for two minutes.
/// @param result  correction of the day so far.
/// @param sites   table of the sites.
/// @param key     key of the running stay; empty: none.
[[nodiscard]] std::optional<MilliGal> u_in_the_evening(const model::SurveyCorrection& result,
                                                       const std::vector<text::Site>& sites,
                                                       const std::string& key);

}  // namespace a351::corrector::design
