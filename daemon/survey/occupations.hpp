#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/survey/recorder.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon {

/// The answer to a request of the operator.
struct Outcome {
    enum class Kind {
        done,     ///< On disk.
        refused,  ///< Against a rule; nothing was written.
        failed    ///< The recorder could not confirm that it is on disk; treated as not done.
    };
    Kind kind = Kind::done;
    std::string message;  ///< One line for the operator.
};

/// What goes with a start or stop.  An empty text is a text not given.
struct Remark {
    std::string operator_name;
    std::string note;
};

/// The occupation that was started and not yet stopped.
struct RunningOccupation {
    std::string site;
    int number = 1;  ///< Counts the stays at this site, discarded ones left out.
    UtcTime start;
    std::vector<UtcTime> set_ups;              ///< Start of each, the first at `start`.
    std::optional<record::SessionId> session;  ///< Of the first sample.
    std::optional<std::int64_t> index;
    Remark remark;
};

/// Starts and stops occupations.  Every change is an event that the recorder has committed before
/// the answer is given, and the state is a function of the events alone: a restarted daemon that
/// replays them is where it was.  Not thread-safe: one thread (that of the page) owns it.
///
/// `at` is an instant of the recorded past, by default that of the last sample.  Refused are: an
/// instant after the last sample or before what the recorder remembers; a start while another runs;
/// a stop or set-up without one, or not after its start; an overlap with a finished occupation; a
/// site that is not in the list (any name will do when the list is empty).  What is allowed but
/// may be a mistake (a site again, a short stay) is said in the answer.
class Occupations {
public:
    struct Options {
        Nanoseconds planned = std::chrono::minutes(10);  ///< Length of a stay.
        MilliGal target{1.0};                            ///< Until the operator sets another.
    };

    /// @param events  the event log so far, in file order.  `recorder` must outlive this.
    Occupations(Recorder& recorder, std::vector<text::Site> sites,
                std::vector<record::Event> events, const Options& options);
    Occupations(Recorder& recorder, std::vector<text::Site> sites,
                std::vector<record::Event> events)
        : Occupations(recorder, std::move(sites), std::move(events), {}) {}

    Outcome start(std::string_view site, const Remark& remark, std::optional<UtcTime> at);
    Outcome stop(const Remark& remark, std::optional<UtcTime> at);
    /// The sensor was lifted and set down again: a further set-up of the running occupation.
    Outcome setup(std::optional<UtcTime> at);

    /// These two speak of the running occupation, or else of the last one that was stopped.
    Outcome discard();
    Outcome rename(std::string_view site, const Remark& remark);

    Outcome note(std::string_view text);

    /// The standard error with which a reading is good enough, from now on: 0.01 to 1000 mGal.
    Outcome set_target(MilliGal target);
    [[nodiscard]] MilliGal target() const noexcept { return target_.value_or(options_.target); }
    [[nodiscard]] Nanoseconds planned() const noexcept { return options_.planned; }

    /// Other sites to start at, another planned length and another target, unless the operator has
    /// set one.
    void use(std::vector<text::Site> sites, const Options& options);
    [[nodiscard]] const std::vector<text::Site>& sites() const noexcept { return sites_; }

    /// Finished ones, as record::occupations_of() reads them from the log.
    [[nodiscard]] std::vector<record::Occupation> list() const;
    [[nodiscard]] const std::optional<RunningOccupation>& running() const noexcept {
        return running_;
    }

private:
    struct Placed {
        std::optional<Instant> instant;
        std::string trouble;
    };

    [[nodiscard]] Placed place(std::optional<UtcTime> at);
    [[nodiscard]] std::optional<std::string> trouble_with_site(std::string_view site) const;
    [[nodiscard]] record::Event about_now(std::string type);
    [[nodiscard]] std::optional<record::Occupation> changed_by(const record::Event& event) const;
    Outcome commit(record::Event event, std::string message);
    void follow(const record::Event& event);
    void renumber();
    [[nodiscard]] std::string remarks_on_stop(UtcTime stop) const;

    Recorder& recorder_;
    Options options_;
    std::optional<MilliGal> target_;  ///< As the operator set it.
    std::vector<text::Site> sites_;
    std::vector<record::Event> events_;
    std::optional<RunningOccupation> running_;
};

}  // namespace a351::daemon
