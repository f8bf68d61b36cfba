#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/survey/recorder.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/occupations.hpp"
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
    std::string message;  ///< One line for the operator.
};

/// Optional texts of a start or stop; empty if not given.
struct Remark {
    std::string operator_name;
    std::string note;
};

struct OccupationOptions {
    Nanoseconds planned = std::chrono::minutes(10);  ///< Planned length of a stay.
    MilliGal target{1.0};                            ///< Target until the operator sets another.
};

/// Starts and stops occupations.  Every change is an event, which the recorder commits before the
/// answer is given.  The state depends on the events only, so a restarted daemon that replays them
/// has the same state.  Not thread-safe: one thread (that of the page) owns it.
///
/// `at` is a time in the recorded past, by default that of the last sample.  Refused are:
/// - a time after the last sample or before the data that the recorder keeps in memory;
/// - a start while an occupation is running;
/// - a stop or set-up without a running occupation, or not after its start;
/// - an overlap with a finished occupation;
/// - a site that is not in the list (any name is allowed if the list is empty).
/// The answer points out a possible mistake (a repeated site, a short stay).
class Occupations {
public:
    /// @param events  the event log so far, in file order.  `recorder` must outlive this.
    Occupations(Recorder& recorder, std::vector<text::Site> sites,
                const std::vector<events::Event>& events, const OccupationOptions& options = {});

    Outcome start(std::string_view site, const Remark& remark, std::optional<UtcTime> at);
    Outcome stop(const Remark& remark, std::optional<UtcTime> at);
    /// Begins a further set-up of the running occupation: the sensor was lifted and set down again.
    Outcome setup(std::optional<UtcTime> at);

    /// Discards or renames the running occupation, or else the one stopped last.
    Outcome discard();
    Outcome rename(std::string_view site, const Remark& remark);

    Outcome note(std::string_view text);

    /// Sets the standard error at which a reading is good enough, from now on: 0.01 to 1000 mGal.
    Outcome set_target(MilliGal target);
    [[nodiscard]] MilliGal target() const noexcept { return target_.value_or(options_.target); }
    [[nodiscard]] Nanoseconds planned() const noexcept { return options_.planned; }

    /// Replaces the list of sites and the planned length, and the target unless the operator has
    /// set one.
    void use(std::vector<text::Site> sites, const OccupationOptions& options);
    [[nodiscard]] const std::vector<text::Site>& sites() const noexcept { return sites_; }

    /// Returns the finished occupations, in order of time.
    [[nodiscard]] std::vector<events::Occupation> list() const { return replay_.finished(); }
    [[nodiscard]] const std::optional<events::RunningOccupation>& running() const noexcept {
        return replay_.running();
    }

private:
    struct Placed {
        std::optional<Instant> instant;
        std::string trouble;
    };

    [[nodiscard]] Placed place(std::optional<UtcTime> at);
    [[nodiscard]] Placed place_in_running(std::optional<UtcTime> at);
    [[nodiscard]] std::optional<std::string> trouble_with_site(std::string_view site) const;
    [[nodiscard]] events::Event about_now(std::string type);
    Outcome commit(events::Event event, std::string message);
    void note_aside(const events::Event& event);

    Recorder& recorder_;
    OccupationOptions options_;
    std::optional<MilliGal> target_;  ///< Target set by the operator.
    std::vector<text::Site> sites_;
    events::OccupationReplay replay_;
    UtcTime last_event_;
};

}  // namespace a351::daemon::survey
