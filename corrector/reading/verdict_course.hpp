#pragma once
/// @file
/// The verdicts that the recorder showed during a survey, from its event log.
///
/// The verdict itself is not computed here: its thresholds are in the recorder's configuration.

#include <string>
#include <vector>

#include "corrector/archive_series/temperature_course.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"

namespace a351::corrector::reading {

/// A time in which one verdict was shown.
struct VerdictSpan {
    UtcTime start, end;
    std::string state;  ///< Word of the event, for example "settling".
};

/// Returns the verdicts in order of time; none if the log has none, as that of older recorders.
///
/// A verdict lasts until the next one.  It is cut to the minutes that have samples, so that a verdict
/// before a pause of the recorder does not fill the pause.
/// @param events  in any order.
/// @param course  in order of time.
[[nodiscard]] std::vector<VerdictSpan> verdict_course(
    std::vector<events::Event> events,
    const std::vector<archive_series::MinuteTemperature>& course);

}  // namespace a351::corrector::reading
