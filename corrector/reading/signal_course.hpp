#pragma once
/// @file
/// The words of the signal that the recorder showed during a survey, from its event log.

#include <string>
#include <vector>

#include "corrector/archive_series/temperature_course.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"

namespace a351::corrector::reading {

/// A time in which one word was shown.
struct SignalSpan {
    UtcTime start, end;
    std::string word;  ///< Code of the event, for example "keep_off".
};

/// Returns the words in order of time; none if the log has none, as that of older recorders.
///
/// A word lasts until the next one.  It is cut to the minutes that have samples, so that a word
/// before a pause of the recorder does not fill the pause.
/// @param events  in any order.
/// @param course  in order of time.
[[nodiscard]] std::vector<SignalSpan> signal_course(
    std::vector<events::Event> events,
    const std::vector<archive_series::MinuteTemperature>& course);

}  // namespace a351::corrector::reading
