#pragma once
/// @file
/// The event log: `events/YYYY-MM.jsonl`, one JSON object per line, appended and synced before the
/// operator gets an answer.  Format: protocol/events/event-format.md.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::record {

struct Event {
    std::string type;  ///< start, stop, setup, discard, rename, note, fault ...
    UtcTime utc;       ///< Instant to which the event refers, on the time scale of the samples.
    std::optional<SessionId> session;
    std::optional<std::int64_t> index;           ///< Sample at that instant.
    std::map<std::string, std::string> details;  ///< site, operator, note ...: text only.
};

/// Returns the event as one line.  Bytes that are not UTF-8 become U+FFFD.
/// @throws std::invalid_argument  a detail is named type, utc, session or index.
[[nodiscard]] std::string to_json(const Event& event);

/// Reads one line.
/// @return std::nullopt unless it is one object with type and utc whose details are all text.
[[nodiscard]] std::optional<Event> parse_event(std::string_view json);

/// Appends one line to the file of the event's month and syncs it.
/// @throws std::system_error  the event was not logged.  Its line is removed, if the disk permits
///                            it.
void append_event(FileLayer& files, const std::filesystem::path& directory, const Event& event);

/// Line that is not an event.
struct EventDamage {
    std::filesystem::path file;
    std::size_t line = 0;
};
struct EventLog {
    std::vector<Event> events;        ///< In file order.
    std::vector<EventDamage> damage;  ///< Lines that are not an event, such as a torn last one.
};
/// Reads all months of a directory; returns nothing if the directory does not exist.
[[nodiscard]] EventLog read_events(const std::filesystem::path& directory);

/// Stay at a benchmark: one or more set-ups of the sensor.
struct Occupation {
    struct SetUp {
        UtcTime start;
        UtcTime end;
    };
    std::string site;
    int number = 1;  ///< Number of the stay at this site, counted from 1 in order of time.
    std::vector<SetUp> set_ups;
    std::string note;
};

/// Returns the occupations that were stopped and not discarded, in order of time.  A start while an
/// occupation runs ends it.  `setup` begins a further set-up.  A running occupation is left out.
/// One that ends before it starts, which the daemon does not log, is returned as it was logged.
/// `discard` and `rename` apply to the running occupation, or else to the last one stopped and not
/// discarded.  Notes of start, stop and rename, and `note` while one runs, are joined by "; ".
/// @param events  in the order in which they were logged.
[[nodiscard]] std::vector<Occupation> occupations_of(const std::vector<Event>& events);

/// Time without the begin of a set-up after which a new survey day begins; longer than any drive
/// between benchmarks.
inline constexpr Nanoseconds kSurveyNight = std::chrono::hours(6);

/// Returns the occupations of the survey day that contains `later`.  Only the starts of set-ups
/// count, so that a stop forgotten in the evening does not join two days.
/// @param occupations  result of occupations_of(), none after `later`.
[[nodiscard]] std::vector<Occupation> survey_day(std::vector<Occupation> occupations,
                                                 UtcTime later);

/// Returns the site of the occupation that still runs after the last event: started, but neither
/// stopped nor discarded.
[[nodiscard]] std::optional<std::string> running_site(const std::vector<Event>& events);

}  // namespace a351::record
