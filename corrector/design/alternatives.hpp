#pragma once
/// @file
/// Changes of a plan, and what each of them brings.
///
///     for (const Alternative& one : alternatives(plan, sites, unit, errors.u_unknown))
///         std::cout << one.text << '\n';
///
/// A visit that is added has the set-ups of the visit before it, and the drives to it take as long as
/// the median of the plan's drives.  All later visits are delayed.

#include <string>
#include <vector>

#include "corrector/design/plan.hpp"
#include "corrector/design/planned_unit.hpp"

namespace a351::corrector::design {

/// A changed plan with its uncertainty.
struct Alternative {
    std::string text;  ///< Change and effect in one sentence.
    Plan plan;
    MilliGal u;                  ///< ExpectedErrors::u_unknown of the changed plan.
    double extra_minutes = 0.0;  ///< Additional time, drives included; can be 0.
};

/// Least improvement of an alternative, as a part of u.  Less is below the accuracy of a prediction.
inline constexpr double kLeastGain = 0.01;
/// The same for turning the box over.  Reason: it is work at each benchmark, and what it does to an oven is
/// not known.
inline constexpr double kLeastGainOfTurning = 0.1;

/// Returns the changes that improve a plan by kLeastGain or more, the best first:
///
/// - the box turned over between the set-ups in the same minutes, if that is better by
///   kLeastGainOfTurning; or, if the plan turns it, the same set-ups in one face,
/// - twice as many set-ups of half the length; only if each keeps three minutes,
/// - one more set-up at each visit, or at those of known stations only,
/// - set-ups twice as long,
/// - a return to the first known station at the end, if the last one is not known, or in the
///   middle,
/// - each of the three nearest known stations of the table that is not visited,
/// - all visits once more in reverse order.
///
/// A change beyond the limits of a plan, kMostSetUps or kMostMinutes, is left out.  The uncertainty
/// of each is that of expected_errors() for the changed plan (alternatives_test.cpp).
/// @param plan   as read_plan() gives it.
/// @param sites  all sites of the plan, and known ones that could be added.
/// @param unit   unit with which `u` was computed.
/// @param u      ExpectedErrors::u_unknown of the plan.
[[nodiscard]] std::vector<Alternative> alternatives(const Plan& plan,
                                                    const std::vector<text::Site>& sites,
                                                    const PlannedUnit& unit, MilliGal u);

}  // namespace a351::corrector::design
