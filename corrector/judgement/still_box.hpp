#pragma once
/// @file
/// Stays at several benchmarks, and set-ups of a stay, during which the box stood at one place.

#include <optional>
#include <vector>

#include "corrector/reading/finding.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::judgement {

/// Returns a finding if the box did not move between four or more stays one after the other, each
/// at another benchmark than the one before: then the times of the stays are wrong.
///
/// It has not moved if its level changes by at most 0.001 deg and the norm by at most 10 mGal.
/// Reason for 10 mGal: the reading of a still box changes by a few with the temperature of an hour.
/// Reason for 0.001 deg: hands at a box that stands still tilt it by no more
/// (signal/moved_box.hpp). Reason for four stays: set-ups levelled within 0.005 deg agree so well
/// once in a hundred times, three times in a row once in a million.
/// @param rows  in order of time; those of a table of averages are never found.
[[nodiscard]] std::optional<reading::Finding> still_box(
    const std::vector<reading::SurveyRow>& rows);

/// Returns the remark not_lifted for each used set-up of a stay that has the level of the used one
/// before within 0.0003 deg and its norm within 10 mGal: the placement error of both is the same,
/// and u is too small. The amendment excludes it.
///
/// Reason for 0.0003 deg: on a simulated day the level of a box at rest changes by at most 0.00013
/// deg in ten minutes.  Set-ups levelled with a scatter of 0.01 deg agree so well once in 4000
/// times.
[[nodiscard]] std::vector<reading::Finding> set_ups_not_lifted(
    const std::vector<reading::SurveyRow>& rows);

}  // namespace a351::corrector::judgement
