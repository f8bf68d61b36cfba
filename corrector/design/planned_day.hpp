#pragma once
/// @file
/// A planned survey day in the form in which the whole-day model takes a measured one.
///
///     PlannedDay day = planned_day(plan, sites, unit, 0);
///     const auto adjusted = whole_day::adjust_planned_day(
///         day.record, {nullptr, day.stations, unit.priors}, unit.noise);
///
/// Temperature and levelling are not known before.  Each course has the statistics of the unit's oven
/// and of a box level; use the mean square of the results over kCourses courses.

#include <string>
#include <vector>

#include "corrector/design/plan.hpp"
#include "corrector/design/planned_unit.hpp"
#include "corrector/reading/day_record.hpp"
#include "corrector/whole_day/day_survey.hpp"

namespace a351::corrector::design {

/// Number of courses of the temperature.  Reason: the root of the mean square of an uncertainty is
/// within 3 % of that over 128 courses (expected_errors_test.cpp).
inline constexpr std::size_t kCourses = 16;

/// Time from the beginning of the record to the first visit, h: what `survey` uses of a night before.
inline constexpr double kLead_h = 8.0;

/// Record and stations of a plan.  Invariant: stations has one element per set-up, in order of time,
/// and their numbers are places in `sites`.
struct PlannedDay {
    reading::DayRecord record;  ///< Bins without readings.
    std::vector<whole_day::DayStation> stations;
    std::vector<std::string> sites;  ///< Names of the stations in order of their first visit.
};

/// Returns a course of the oven's temperature.
///
/// It is the sum of 42.5 degC, a random walk and the oven's cycle (900 s, 0.02 degC peak to peak).
/// The random walk consists of waves of 1 to 64 h, one per octave.  The phases are parts of
/// multiples of square roots of primes, so that the courses 0 to n - 1 cover all phases evenly.
/// There is no random number.
/// @param start  of the record.
/// @param end    of the day, after start.
/// @param walk_degc_per_sqrt_h  rms change per square root of an hour.
/// @param course  number of the course, from 0.
[[nodiscard]] TimeSeries<DegC> planned_temperature(UtcTime start, UtcTime end,
                                                   double walk_degc_per_sqrt_h, std::size_t course);

/// Returns the day of a plan.
///
/// A set-up has the bins of its 2 s samples without 25 s at either end: 15 s for a hand at the box,
/// and the reach of the filters.  Its tilt has a fixed size.  The direction of the tilt turns from
/// set-up to set-up by the golden angle times the number of the course from 1.  So the differences
/// of two set-ups cover all directions.
/// @param plan   as read_plan() gives it.
/// @param sites  has every site of the plan; gravity and its uncertainty are those of the stations.
/// @param course  number of the course, from 0.
[[nodiscard]] PlannedDay planned_day(const Plan& plan, const std::vector<text::Site>& sites,
                                     const PlannedUnit& unit, std::size_t course);

}  // namespace a351::corrector::design
