#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/survey/recorder.hpp"
#include "daemon/survey/signal.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::survey {

/// The answer to a request of the operator.
struct Outcome {
    enum class Kind {
        done,     ///< On disk.
        refused,  ///< Not allowed; nothing was written.
        failed    ///< Not confirmed to be on disk; treated as not done.
    };
    Kind kind = Kind::done;
    text::Message message;  ///< One line for the operator.
};

/// Optional texts of a change; empty if not given.
struct Remark {
    std::string operator_name{};
    std::string note{};
    std::string reason{};  ///< Why a stay is changed.
};

/// A stay that is to be changed.
struct Named {
    std::string key{};   ///< Key of the stay, see events::Occupation::key.
    std::string site{};  ///< Site under which the operator saw it; empty: not checked.
};

/// Longest time after a stop in which the stay can be resumed.  Reason: later the box was probably
/// moved.
inline constexpr Nanoseconds kLongestResume = std::chrono::minutes(10);

/// Farthest that a stay is extended at either end.  Reason: farther away is another day, by a
/// mistyped date.
inline constexpr Nanoseconds kFarthestRetime = std::chrono::hours(24);

/// Length of each set-up of a stay with a plan of its own.  Reason: two whole minutes between the
/// disturbances give a set-up a scatter, and a placement test of twenty fits into an hour.
inline constexpr Nanoseconds kTestSetUp = std::chrono::minutes(3);

struct OccupationOptions {
    Nanoseconds planned = std::chrono::minutes(10);  ///< Planned length of a stay, all set-ups.
    int planned_set_ups = 1;                         ///< Planned set-ups of a stay, equally long.
    /// Faces of the set-ups of a stay, + as the first one and - turned over, one after the other; further
    /// ones have the last face.
    std::string faces = "+";
    std::filesystem::path sites_file = {};  ///< List that gets new sites; empty: there is none.
    std::optional<text::Site> station =
        {};  ///< Position of the configuration, compared with the list.
};

/// Starts and stops occupations.  Every change is an event, which the recorder commits before the
/// answer is given.  The state depends on the events only, so a restarted daemon that replays them
/// has the same state.  Not thread-safe: one thread (that of the page) owns it.
///
/// `at` is a time in the recorded past, by default that of the last sample.  If the clock was set back
/// behind a set-up of the running stay, the stay keeps its own time: the last sample is then as long
/// after the start of the stay as the signal in between.  The event names this sample, so that
/// a351-correct retime gives it the true time.  Refused are:
/// - a time after the last sample, and for start, stop and set-up one before the data that the
///   recorder keeps in memory;
/// - a start while an occupation is running;
/// - a stop or set-up without a running occupation, or not after its last set-up;
/// - an overlap with a finished occupation, if `at` is given: what begins or ends now is after all that
///   is finished, also by a clock that is behind the recorded data;
/// - a site that is not in the list (any name is allowed if the list is empty);
/// - a change of a stay whose key names none, or whose site is another than the operator saw.
/// A start, stop or set-up that was made already, at the same instant, is done and changes nothing.
/// The answer points out a possible mistake (a repeated site, a short stay).
class Occupations {
public:
    /// @param events  the event log so far, in file order.  `recorder` must outlive this.
    Occupations(Recorder& recorder, std::vector<text::Site> sites,
                const std::vector<events::Event>& events, const OccupationOptions& options = {});

    /// @param set_ups  planned number of set-ups of this stay, 2 to 100, each kTestSetUp long;
    ///                 absent: as configured.  A placement test has 20.
    /// @param face     face of the first set-up, as the operator says.
    Outcome start(std::string_view entered, const Remark& remark, std::optional<UtcTime> at,
                  std::optional<int> set_ups = {}, std::optional<int> face = {});
    Outcome stop(const Remark& remark, std::optional<UtcTime> at);
    /// Begins a further set-up of the running occupation: the sensor was lifted and set down again.
    Outcome setup(std::optional<UtcTime> at, const events::StatedFace& face = {});

    // Changes of any stay (occupation_changes.cpp).  Its data are kept in any case.
    /// Discards a stay; a running one ends.
    Outcome discard(const Named& stay, const Remark& remark);
    /// Cancels a discard, unless the stay overlaps another one by now.
    Outcome restore(const Named& stay, const Remark& remark);
    /// Continues the last stay as if it had not been stopped, up to kLongestResume later.
    Outcome resume(const Named& stay, const Remark& remark);
    /// @param entered  the correct site.
    Outcome rename(const Named& stay, std::string_view entered, const Remark& remark);
    /// Moves the start (`from`), the end (`to`) or both.  Set-ups outside are left out.
    Outcome retime(const Named& stay, std::optional<UtcTime> from, std::optional<UtcTime> to,
                   const Remark& remark);

    /// Says that the box was not moved during a stay so far.
    Outcome not_moved(const Named& stay, const Remark& remark);

    /// Writes a note to a stay; without a key to the running one, or else to the log alone.
    Outcome note(const Named& stay, std::string_view text);

    /// Says that the operator has looked at a contradiction: a note, which the signal does not repeat.
    Outcome check(const Contradiction& contradiction);
    /// Returns true if he has, within a day.
    [[nodiscard]] bool is_checked(const Contradiction& contradiction, UtcTime now) const {
        const auto found = checked_.find({contradiction.code, contradiction.key});
        return found != checked_.end() && now - found->second < std::chrono::hours(24);
    }

    /// Returns the planned length of the running stay, or else of the next one.
    [[nodiscard]] Nanoseconds planned() const noexcept;
    /// Returns the planned number of set-ups of the same stay.
    [[nodiscard]] int planned_set_ups() const noexcept;
    /// Returns the planned face of the set-up of this number, from 1: 1 as the first one of the stay, -1
    /// turned over.  A stay with a plan of its own has one face.
    [[nodiscard]] int planned_face(int set_up) const noexcept;
    /// Returns true if the plan of the running stay has faces.
    [[nodiscard]] bool has_planned_faces() const noexcept {
        return options_.faces.size() > 1 && !(running() && running()->planned_set_ups);
    }

    /// Logs that another sensor records, and ends the running stay.
    /// @param event  `other_unit`, with the last sample of the sensor before.
    void end_at_exchange(events::Event event);

    /// Returns the end of the survey day: events::kSurveyNight after the newest begin of a set-up.
    /// UtcTime::max() while a stay is running, UtcTime::min() if there is none.
    [[nodiscard]] UtcTime day_end() const;

    /// Appends a site to the list, see append_site(), and uses it from now on.
    Outcome add_site(const text::Site& site);

    /// Replaces the list of sites and the plan of a stay.
    void use(std::vector<text::Site> sites, const OccupationOptions& options);
    [[nodiscard]] const std::vector<text::Site>& sites() const noexcept { return sites_; }
    [[nodiscard]] const std::filesystem::path& sites_file() const noexcept {
        return options_.sites_file;
    }
    /// See text::doubtful_site().
    [[nodiscard]] const text::Message& doubtful_site() const noexcept { return doubtful_site_; }

    /// Returns the number of changes of stays, notes and sites since the start.
    [[nodiscard]] std::uint64_t changes() const noexcept { return changes_; }

    /// Returns the finished occupations, in order of time.
    [[nodiscard]] std::vector<events::Occupation> list() const { return replay_.finished(); }
    /// Returns the discarded occupations, in order of time.
    [[nodiscard]] std::vector<events::Occupation> discarded() const { return replay_.discarded(); }
    [[nodiscard]] const std::optional<events::RunningOccupation>& running() const noexcept {
        return replay_.running();
    }

private:
    struct Placed {
        std::optional<Instant> instant;
        text::Message trouble;
    };

    /// A stay as it is now.
    struct Found {
        enum class State { running, finished, discarded };
        State state = State::finished;
        std::string site;
        text::Message text;          ///< Site, number and times; empty: there is no such stay.
        UtcTime start, end;          ///< A stay that still runs ends at the last sample.
        text::Message trouble = {};  ///< Why it is not the stay that is named; empty if it is.
    };

    [[nodiscard]] Found found(const Named& stay);
    [[nodiscard]] text::Message trouble_with_overlap(const std::string& key, UtcTime start,
                                                     UtcTime end) const;
    [[nodiscard]] events::Event change_of(std::string type, const Named& stay,
                                          const Remark& remark);
    [[nodiscard]] std::optional<Instant> newest();
    [[nodiscard]] UtcTime own_time(const Instant& sample);
    [[nodiscard]] Instant in_running(Instant sample);
    [[nodiscard]] text::Message remark_on_clock();
    [[nodiscard]] Placed place(std::optional<UtcTime> at);
    [[nodiscard]] bool is_at(std::optional<UtcTime> at, UtcTime utc);
    [[nodiscard]] Placed place_in_running(std::optional<UtcTime> at, bool is_stop);
    [[nodiscard]] std::optional<text::Message> trouble_with_site(std::string_view site) const;
    [[nodiscard]] events::Event about_now(std::string type);
    void note_aside(const events::Event& event);
    Outcome commit(events::Event event, text::Message message);
    void take(std::vector<text::Site> sites);
    void observe(const events::Event& event);

    Recorder& recorder_;
    OccupationOptions options_;
    std::vector<text::Site> sites_;
    text::Message doubtful_site_;
    events::OccupationReplay replay_;
    UtcTime last_event_;
    /// When contradictions were checked, by code and key.
    std::map<std::pair<std::string, std::string>, UtcTime> checked_;
    std::uint64_t changes_ = 0;
};

}  // namespace a351::daemon::survey
