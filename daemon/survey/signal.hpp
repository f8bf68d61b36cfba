#pragma once
/// @file
/// The signal, which says what the operator should do now.  Page, terminal, metrics, event log and
/// report show it.
///
/// A stay is complete when its plan is complete.  The temperature, its slope and the scatter of the
/// samples have no part in this, because they do not predict the error of the corrected value
/// (corrector/methods.md, "What a stay can tell").  A contradiction is shown while the box is still
/// at the benchmark.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/verdict/verdict.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::survey {

enum class Word {
    no_data,     ///< No values arrive.
    warming_up,  ///< The box is not at its operating temperature.
    keep_off,    ///< The set-up runs.
    lift,        ///< The set-up is complete, and another one is planned.
    go,          ///< The plan is complete, or no stay runs.
    look         ///< Something contradicts a reading, or the sensor is not to be believed.
};

/// Return the code of a word, as "keep_off", and the word itself, as "KEEP OFF".
[[nodiscard]] std::string_view code_of(Word word) noexcept;
[[nodiscard]] std::string_view to_text(Word word) noexcept;

/// A contradiction, which the operator can still clear up.
struct Contradiction {
    std::string code;                  ///< Which one.
    std::string key;                   ///< Key of its stay; empty: it concerns no stay.
    text::Message text;                ///< What, how much, and what to do.
    std::vector<std::string> buttons;  ///< Codes of the answers, at most two.
};

/// Codes of two contradictions: the box was moved; the box is in the wrong face.
inline constexpr const char* kMoved = "moved";
inline constexpr const char* kFace = "face";
/// The answer that the operator has looked at a contradiction.
inline constexpr const char* kChecked = "checked";

/// The plan of a running stay: `planned` set-ups of equal length.
struct SetUpPlan {
    int running = 1;  ///< Number of the set-up that runs, from 1.
    int planned = 1;  ///< Planned set-ups.
    /// Seconds left in the set-up; in the last one, or beyond the plan, not less than in the stay.
    double left_s = 0.0;
    bool is_disturbed = false;  ///< Time was added, because too much signal was disturbed.

    [[nodiscard]] bool needs_next() const { return left_s == 0.0 && running < planned; }
    [[nodiscard]] bool is_complete() const { return left_s == 0.0 && running >= planned; }
};

/// Returns the place in a plan.
///
/// A set-up is complete after its planned length, if half of this length was undisturbed.  Reason:
/// half the length has an error larger by 4 to 8 %.  The last one is not complete before the planned
/// length of the stay.
/// @param length_s  planned length of all set-ups together.
/// @param stay_s    seconds since the start of the stay.
/// @param set_up_s  seconds since the start of the running set-up.
/// @param used_s    seconds of its signal that no knock disturbed.
[[nodiscard]] SetUpPlan set_up_plan(int planned, double length_s, int running, double stay_s,
                                    double set_up_s, double used_s);

/// A running stay as the signal sees it.
struct PlannedStay {
    std::string site;
    SetUpPlan plan;
    bool is_compared = false;  ///< The corrector has compared it with other readings.
    bool turns_next = false;   ///< The next set-up is in the other face.
};

struct Signal {
    Word word = Word::no_data;
    std::string_view text;  ///< The word as people read it; without a stay not that of `go`.
    text::Message sentence;
    std::vector<std::string> buttons;   ///< At most two: start, setup, stop, or those of `look`.
    std::optional<Contradiction> look;  ///< With the word `look` only.
};

/// Returns the word alone.
[[nodiscard]] Word word_of(verdict::State state, const std::optional<PlannedStay>& stay,
                           bool has_contradiction);

/// Returns the signal.
/// @param why             why the verdict is not better.
/// @param last_site       site of the last stay of the day; empty: there is none.
/// @param contradictions  those that were not answered; the first is shown.
[[nodiscard]] Signal signal_of(const verdict::Verdict& verdict,
                               const std::vector<text::Message>& why,
                               const std::optional<PlannedStay>& stay, const std::string& last_site,
                               const std::vector<Contradiction>& contradictions);

}  // namespace a351::daemon::survey
