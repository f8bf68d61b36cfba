#pragma once
/// @file
/// The rules that make occupations of events.  Daemon and corrector use this one replay, so the
/// page and the later correction show the same occupations.
///
/// An occupation is a stay at a benchmark; a set-up is the part of it in which the sensor was not
/// lifted.  The log keeps every event; only the replay says which of them still count.
///
///     OccupationReplay replay(read_events(root / "events").events);
///     replay.take(event);                                     // each further event
///     const auto today = survey_day(replay.finished(), now);
///
/// Nothing here reads a file or a clock.  Equal events give equal occupations.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/events/face.hpp"

namespace a351::events {

/// Limits of the detail `set_ups` of a start.  Reason: one is no plan of set-ups; more than a
/// hundred, five hours at three minutes each, are a slip of the hand.
inline constexpr int kFewestPlannedSetUps = 2;
inline constexpr int kMostPlannedSetUps = 100;

[[nodiscard]] constexpr bool is_planned_set_ups(int count) noexcept {
    return count >= kFewestPlannedSetUps && count <= kMostPlannedSetUps;
}

/// Reads the detail `set_ups`.
/// @return std::nullopt if the text is no whole number within the limits.
[[nodiscard]] std::optional<int> parse_planned_set_ups(std::string_view text) noexcept;

/// Stay at a benchmark that has ended: one or more set-ups of the sensor.
///
/// The replay never gives an occupation without set-ups.  Two stays can overlap, and an end can be
/// before its start, in a log that the daemon did not make.
struct Occupation {
    /// Key of the stay: its start as YYYYMMDDTHHMMSSZ when it was entered; if another stay has it,
    /// the next free second.  It never changes and is never given again.
    std::string key;
    /// One placement of the sensor.
    struct SetUp {
        UtcTime start;  ///< Time of the start of the stay, or of the event `setup`.
        UtcTime end;    ///< Start of the next set-up, or end of the stay; never equal to `start`.
        StatedFace face = {};
    };
    /// Name of the benchmark as entered; empty if the event has none.  No table is consulted.
    std::string site;
    int number = 1;  ///< Number of the stay at this site, counted from 1 in order of time.
    std::vector<SetUp> set_ups;  ///< At least one, in the order of the events.
    std::string note;            ///< Notes joined by "; "; empty if there are none.
    bool is_stopped = true;      ///< False: it has no stop, and the next start ended it.
    /// The operator says that the box was not moved before this instant.
    std::optional<UtcTime> not_moved_until{};
    std::string operator_name{};  ///< Detail `operator` of the start; empty if not given.
};

/// The stay that was started and has not ended.
///
/// Times and texts are those of the events so far.
struct RunningOccupation {
    std::string key;   ///< Key of the stay, see Occupation::key.
    std::string site;  ///< Name of the benchmark, after renames.
    /// Number of this stay at the site, one more than the finished stays there.  If one of these is
    /// later, the stay gets a smaller number when it ends.
    int number = 1;
    UtcTime start;  ///< Start of the stay.
    /// Start of each set-up; the first is `start`.  A set-up without duration is still included.
    std::vector<UtcTime> set_ups;
    /// Faces of the set-ups, by their starts as logged.
    std::map<UtcTime, StatedFace> faces = {};
    /// Returns the face of the set-up that runs at an instant: a moved start keeps its face.
    [[nodiscard]] StatedFace face_at(UtcTime time) const;
    /// Session and index of the first sample; absent if the start was moved.
    std::optional<journal::SessionId> session;
    std::optional<std::int64_t> index;
    std::string operator_name;  ///< Detail `operator` of the start; empty if not given.
    std::string note;           ///< Notes so far, joined by "; ".
    std::optional<UtcTime> not_moved_until{};  ///< As Occupation::not_moved_until.
    /// Detail `set_ups` of the start: planned set-ups of this stay; absent if not
    /// given or not within the limits.
    std::optional<int> planned_set_ups{};
};

/// Applies events one by one.
///
/// - `start` begins an occupation.  If one runs, this ends it.
/// - `setup` begins a further set-up of the running one, `stop` ends it.
/// - The details `face` and `planned_face` of `start` and `setup` are + or -; other texts count as none.
/// - `discard`, `restore`, `resume`, `rename`, `retime` and `note` apply to the stay that their
///   detail `key` names; with a key that names none they change nothing.
/// - Without a key, `discard` and `rename` apply to the running occupation, or else to the last one
///   that ended and was not discarded; `note` to the running one; the others change nothing.
/// - `discard` of the running occupation ends it, too.  `restore` cancels a discard.
/// - `resume` cancels the end of a stay if none runs.
/// - `retime` moves the start (`from`), the end (`to`) or both; set-ups outside are left out, and of
///   a stay that ended they come back with a later `retime`.
/// - `not_moved` says that the box was not moved during the stay, up to the instant of the event.
/// - Notes of start, stop, rename and `note` are joined by "; ".
/// - A `stop` that names another site ends the running occupation, and its notes say so.
/// - `other_unit` ends the running occupation, and its notes say so.
/// - A set-up without duration is left out, and so is an occupation without set-ups.
/// - `setup` and `stop` change nothing if no occupation runs.  Other types change nothing.
///
/// An occupation that ends before it starts, which the daemon does not log, is kept as it was
/// logged.
///
/// Stays are numbered again after every event.  A stay entered later for an earlier time, a rename
/// or a discard therefore changes the numbers of other stays at the site.
///
/// An event costs O(m log m) for m ended occupations.  One thread at a time may use an object that
/// changes.
class OccupationReplay {
public:
    OccupationReplay() = default;
    /// @param events  in the order in which they were logged.
    explicit OccupationReplay(const std::vector<Event>& events) {
        for (const Event& event : events) apply(event);
        renumber();
    }

    /// Applies the next event in the order of the log.  A missing detail counts as empty text.
    void take(const Event& event);

    /// Returns the occupations that ended and were not discarded, in order of time: by the start of
    /// their first set-up.  Stays with equal starts are in the order in which they ended.
    [[nodiscard]] std::vector<Occupation> finished() const;
    /// Returns the occupations that were discarded, in the same order.
    [[nodiscard]] std::vector<Occupation> discarded() const;
    /// Returns the key that a stay with this start gets.
    [[nodiscard]] std::string key_for(UtcTime start) const;
    /// Returns the occupation that still runs after the last event; absent if none runs.  The
    /// reference is to a member, which the next take() changes.
    [[nodiscard]] const std::optional<RunningOccupation>& running() const noexcept {
        return running_;
    }

private:
    /// A stay that ended, with what `resume` needs.
    struct Ended {
        RunningOccupation stay;
        UtcTime end;
        bool is_stopped = true, is_discarded = false;
        std::optional<UtcTime> from{};  ///< Start by `retime`; set by every `retime`.
    };

    void apply(const Event& event);
    void start(const Event& event);
    void end_running(UtcTime end, bool is_stopped);
    void rename(const Event& event);
    void discard(const Event& event);
    void resume(const Event& event);
    void retime(const Event& event);
    void renumber();
    [[nodiscard]] Ended* ended_of(const Event& event);
    [[nodiscard]] RunningOccupation* stay_of(const Event& event);
    [[nodiscard]] static std::vector<UtcTime> starts_of(const Ended& ended);
    [[nodiscard]] std::vector<Occupation> stays(bool are_discarded) const;

    std::optional<RunningOccupation> running_;
    std::vector<Ended> ended_;                 ///< In the order in which they ended; numbered.
    std::set<std::string, std::less<>> keys_;  ///< All keys ever given.
};

/// Returns the finished occupations of a log.  A running one is not included.
/// @param events  in the order in which they were logged.
[[nodiscard]] inline std::vector<Occupation> occupations_of(const std::vector<Event>& events) {
    return OccupationReplay(events).finished();
}

/// Time without the begin of a set-up after which a new survey day begins; longer than any drive
/// between benchmarks.
inline constexpr Nanoseconds kSurveyNight = std::chrono::hours(6);

/// Returns the occupations of the survey day that contains `later`.  Only the starts of set-ups
/// count, so that a stop forgotten in the evening does not join two days.
///
/// It goes back from `later` until no set-up begins for kSurveyNight.  A pause of exactly this
/// length separates two days.
/// @param occupations  as OccupationReplay::finished() returns them, none after `later`.
/// @param later        instant of the day, for example now or the start of the last set-up.
/// @return in the given order; empty if no set-up begins within kSurveyNight before `later`.
[[nodiscard]] std::vector<Occupation> survey_day(std::vector<Occupation> occupations,
                                                 UtcTime later);

}  // namespace a351::events
