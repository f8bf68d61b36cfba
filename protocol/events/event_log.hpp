#pragma once
/// @file
/// The event log: `events/YYYY-MM.jsonl`, one JSON object per line, appended and synced before the
/// operator gets his answer.  Format: protocol/events/event-format.md.

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
    UtcTime utc;       ///< Instant it speaks of, on the record's time.
    std::optional<SessionId> session;
    std::optional<std::int64_t> index;           ///< Sample at that instant.
    std::map<std::string, std::string> details;  ///< site, operator, note ...: text only.
};

/// One line.  Bytes that are no UTF-8 become U+FFFD.
/// @throws std::invalid_argument  a detail is named type, utc, session or index.
[[nodiscard]] std::string to_json(const Event& event);

/// @return std::nullopt unless it is one object with type and utc whose details are all text.
[[nodiscard]] std::optional<Event> parse_event(std::string_view json);

/// Appends one line to the file of the event's month and syncs it.
/// @throws std::system_error  nothing of it is there, unless the disk does not even take it back.
void append_event(FileLayer& files, const std::filesystem::path& directory, const Event& event);

struct EventDamage {
    std::filesystem::path file;
    std::size_t line = 0;
};
struct EventLog {
    std::vector<Event> events;        ///< In file order.
    std::vector<EventDamage> damage;  ///< Lines that are no event, such as a torn last one.
};
/// All months of a directory; nothing when there is none.
[[nodiscard]] EventLog read_events(const std::filesystem::path& directory);

/// One stay at a benchmark: one or more set-ups of the sensor.
struct Occupation {
    struct SetUp {
        UtcTime start;
        UtcTime end;
    };
    std::string site;
    int number = 1;  ///< Counts the stays at this site.
    std::vector<SetUp> set_ups;
    std::optional<bool> used;
    std::string note;
};

/// Occupations that were started and stopped and not discarded, in time order.  A start while
/// another runs ends that one; `setup` begins a further set-up; a running one is left out.  One that
/// ends before it starts, which the daemon does not log, stands as it was logged.  `discard`
/// and `rename` speak of the running occupation, or else of the last one stopped and not discarded;
/// notes of start, stop and rename, and `note` while one runs, are joined by "; ".
/// @param events  in the order they were logged.
[[nodiscard]] std::vector<Occupation> occupations_of(const std::vector<Event>& events);

/// A survey day ends where no set-up begins for so long: longer than any drive between benchmarks.
inline constexpr Nanoseconds kSurveyNight = std::chrono::hours(6);

/// Returns the occupations of the survey day that contains `later`.  Starts count, not ends: a stop forgotten in the
/// evening does not join two days.
/// @param occupations  as of occupations_of(), none after `later`.
[[nodiscard]] std::vector<Occupation> survey_day(std::vector<Occupation> occupations,
                                                 UtcTime later);

/// Site of the occupation that still runs after the last event: started, neither stopped nor
/// discarded.
[[nodiscard]] std::optional<std::string> running_site(const std::vector<Event>& events);

}  // namespace a351::record
