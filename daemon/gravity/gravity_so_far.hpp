#pragma once
/// @file
/// Gravity so far: a thread that runs the corrector on the data root while it is being recorded, and
/// keeps its last answer for the page.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "protocol/child/child_program.hpp"

namespace a351::daemon::gravity {

struct GravityOptions {
    /// Program and arguments; empty: nothing is run, for `reason`.
    std::vector<std::string> command;
    std::string reason{};  ///< Code of the document without a command.
    std::chrono::milliseconds every{std::chrono::minutes(3)};  ///< Real time, while a stay runs.
    /// Real time after a change until the corrector runs a second time.  Reason: the temperature
    /// after a stop is filtered with data that follow it.
    std::chrono::milliseconds again{std::chrono::seconds(20)};
    child::ChildLimits limits{.cpu_s = 60, .memory_bytes = std::size_t{2} << 30U};
    /// Receives code and cause of a failure, once until another one or a success follows.
    std::function<void(const std::string& reason, const std::string& cause)> failed{};
};

/// The files of a survey from which the gravity so far is computed.
struct SurveyFiles {
    std::filesystem::path root;         ///< Data root.
    std::filesystem::path sites;        ///< List of sites; empty: there is none.
    std::filesystem::path calibration;  ///< Calibration of the unit; empty: there is none.
};

/// Returns the options for a survey.  Without a list of sites (`no_sites`), or if `every` is 0
/// (`off`), they have no command but this reason.
/// @param corrector  path of the program a351-correct.
[[nodiscard]] GravityOptions options_for(const std::filesystem::path& corrector,
                                         const SurveyFiles& files, std::chrono::milliseconds every);

/// Runs the corrector after each change of the occupations, again a little later, and regularly
/// while a stay runs; never twice at a time.
///
/// The document is the corrector's (a351-correct-survey(1), --json).  If the last run failed it is
/// the last good one, with `reason` and `reason_text` of the failure:
/// - no_corrector, failed, killed, too_slow, too_much_output: its run, see child::Outcome;
/// - no_document: the output is not one JSON object;
/// - not_yet: the corrector has not run since the daemon started.
class GravitySoFar {
public:
    explicit GravitySoFar(GravityOptions options);
    ~GravitySoFar() { stop(); }

    void start() {
        thread_ = std::thread([this] { run(); });
    }
    /// Ends the thread and its child within a second.
    void stop();

    /// Takes the command of other options, or their reason for none.  Any thread.
    void use(const GravityOptions& options);

    /// Says that the occupations have changed, and whether a stay runs now.  Any thread.
    void note_change(bool is_running);

    /// Returns the document as JSON text.  Any thread.
    [[nodiscard]] std::string document() const;

private:
    using Time = std::chrono::steady_clock::time_point;
    /// Answer of one run.
    struct Answer {
        std::string document, reason, cause;  ///< A document has no reason.
    };

    void run();
    [[nodiscard]] std::optional<Time> next_run() const;
    /// Runs the corrector; returns the document, or the reason and its cause.
    [[nodiscard]] Answer ask(std::vector<std::string> command) const;
    void take(Answer answer);

    const GravityOptions options_;  ///< Its command is that of the start.
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_;  ///< Protects all below; never locked while the child runs.
    std::vector<std::string> command_;
    std::condition_variable woken_;
    bool is_stay_running_ = false;
    std::optional<Time> now_, again_, last_run_;  ///< Runs that are due; start of the last run.
    std::string document_;                        ///< Last good document; empty: none.
    std::string reason_ = "not_yet", cause_;
    std::thread thread_;
};

}  // namespace a351::daemon::gravity
