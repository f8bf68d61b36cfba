#pragma once
/// @file
/// The event log: `events/YYYY-MM.jsonl`, one JSON object per line, appended and synced before the
/// operator gets an answer.  Format: protocol/events/event-format.md.
///
/// Use it for actions of the operator and for incidents of a run.  Samples belong to the journal
/// and the archive.  A line is never changed: a mistake is corrected by a further event.
///
///     append_event(posix_files(), root / "events", event);
///     const EventLog log = read_events(root / "events");
///     const OccupationReplay replay(log.events);  // occupations.hpp
///
/// One thread of one process at a time may append.  A reader in another process can find the last
/// line incomplete; it is then in EventLog::damage.

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

namespace a351::events {

/// An event: its kind, its instant and texts.
///
/// A default-constructed event has no type.  to_json() writes it, but parse_event() refuses the
/// line.
struct Event {
    std::string type;  ///< start, stop, setup, discard, rename, note, fault ...
    UtcTime utc;       ///< Instant to which the event refers, on the time scale of the samples.
    std::optional<journal::SessionId> session;   ///< Run of sampling, as in the journal.
    std::optional<std::int64_t> index;           ///< Sample at that instant.
    std::map<std::string, std::string> details;  ///< site, operator, note ...: text only.

    /// Returns a detail; empty without it.
    [[nodiscard]] std::string detail(const std::string& key) const;
};

/// Returns the event as one line.  Bytes that are not UTF-8 become U+FFFD.
///
/// The line has no newline at its end, and none inside: control characters are escaped.  Its keys
/// are type, utc (nine decimals), session, index, then the details in the order of their names.
/// parse_event() gives back the same event if its type is not empty and its texts are UTF-8
/// (event_log_test.cpp).
/// @throws std::invalid_argument  a detail is named type, utc, session or index.
[[nodiscard]] std::string to_json(const Event& event);

/// Reads one line.
///
/// Unknown types are accepted.  A session must have 32 hexadecimal digits, an index must be a whole
/// number, and utc an instant of parse_rfc3339().  Invalid text does not throw.
/// @param json  one line; blanks around the object are allowed.
/// @return std::nullopt unless it is one object with type and utc whose details are all text.
[[nodiscard]] std::optional<Event> parse_event(std::string_view json);

/// Appends one line to the file of the event's month and syncs it.
///
/// The month is that of Event::utc, not that of the entry.  A missing directory or file is created;
/// the directory is synced too, each time.  If a crash has torn the last line, the event begins
/// on a line of its own (event_log_test.cpp tears it at every byte).
/// @param files      posix_files(), or a layer that fails on purpose in a test.
/// @param directory  folder `events` of the data root.
/// @throws std::invalid_argument  as to_json().
/// @throws std::system_error  the event was not logged.  Its line is removed, if the disk permits
///                            it.
void append_event(files::FileLayer& files, const std::filesystem::path& directory,
                  const Event& event);

/// Line that is not an event.
struct EventDamage {
    std::filesystem::path file;  ///< File of the log, with the directory as given.
    std::size_t line = 0;        ///< Number of the line, from 1.
};
/// The content of a log.
///
/// Months are in ascending order, and the events of a month in the order of entry.  Event::utc may
/// go back, because an event may refer to the recorded past.
struct EventLog {
    std::vector<Event> events;        ///< In file order.
    std::vector<EventDamage> damage;  ///< Lines that are not an event, such as a torn last one.
};
/// Reads all months of a directory; returns nothing if the directory does not exist.
///
/// In a merged copy of a data root lines are there twice.  A repeated start, stop or set-up counts
/// once, and so do the equal lines before and after it.  A copy with none of these cannot be
/// recognised.  Only names of the shape `####-##.jsonl` are read.  A line that is not an event is
/// skipped, and the lines after it are read; an empty line counts as damage.
/// @throws std::system_error  the directory cannot be listed, or a file cannot be opened.
[[nodiscard]] EventLog read_events(const std::filesystem::path& directory);

}  // namespace a351::events
