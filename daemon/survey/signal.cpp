#include "daemon/survey/signal.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace a351::daemon::survey {
namespace {

using text::marked;

constexpr double kLeastUsed = 0.5;  ///< Least part of a set-up that is undisturbed.

/// Returns a time that is left, as "2:10".
std::string minutes_of(double seconds) {
    const auto whole = static_cast<int>(std::ceil(seconds));
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

text::Message of_warm_up(const verdict::Verdict& verdict, const std::vector<text::Message>& why) {
    text::Message sentence = text::message("The box is not at its operating temperature yet");
    if (!why.empty()) sentence += ": " + why.front();
    if (verdict.time_left_s && *verdict.time_left_s > 0.0)
        sentence += text::message(". At least {} min more",
                                  static_cast<int>(std::ceil(*verdict.time_left_s / 60.0)));
    return sentence + ".";
}

/// Returns where a stay is in its plan, and what to do.
text::Message of_plan(const PlannedStay& stay) {
    const SetUpPlan& plan = stay.plan;
    if (plan.needs_next() && stay.turns_next)
        return text::message(
            "{}: set-up {} of {} is complete. Turn the box over, set it down level, then press "
            "Next set-up.",
            stay.site, plan.running, plan.planned);
    if (plan.needs_next())
        return text::message(
            "{}: set-up {} of {} is complete. Lift the box, set it down level, then press Next "
            "set-up.",
            stay.site, plan.running, plan.planned);
    if (plan.is_complete())
        return stay.is_compared
                   ? text::message("{}: the reading is complete. Press Stop, then go.", stay.site)
                   : text::message(
                         "{}: the plan is complete. The reading was not compared with "
                         "others yet. Press Stop, then go.",
                         stay.site);
    text::Message sentence =
        text::message("{}: set-up {} of {}, {} left", stay.site, plan.running,
                      std::max(plan.planned, plan.running), minutes_of(plan.left_s));
    if (plan.is_disturbed)
        sentence += text::message(", because more than half of it was disturbed");
    return sentence + ".";
}

text::Message of_no_data(const verdict::Verdict& verdict, const std::vector<text::Message>& why) {
    if (verdict.lack == verdict::Lack::values)
        return text::message("Values arrive. The signal needs 20 s of them without a gap.");
    if (verdict.lack == verdict::Lack::changes && !why.empty())
        return text::message("The values cannot be used: {}. Switch the sensor off and on.",
                             why.front());
    text::Message sentence = text::message("No values arrive");
    if (!why.empty()) sentence += ": " + why.front();
    return sentence + text::message(". Check the sensor's plug and its power supply.");
}

}  // namespace

std::string_view code_of(Word word) noexcept {
    // In the order of the enumerators.
    constexpr std::array kCodes{"no_data", "warming_up", "keep_off", "lift", "go", "look"};
    return kCodes.at(static_cast<std::size_t>(word));
}

std::string_view to_text(Word word) noexcept {
    constexpr std::array kTexts{marked("NO DATA"),        marked("WARMING UP"), marked("KEEP OFF"),
                                marked("LIFT, SET DOWN"), marked("YOU CAN GO"), marked("LOOK")};
    return kTexts.at(static_cast<std::size_t>(word));
}

SetUpPlan set_up_plan(int planned, double length_s, int running, double stay_s, double set_up_s,
                      double used_s) {
    SetUpPlan plan;
    plan.running = running;
    plan.planned = planned;
    const double planned_s = length_s / planned;
    double by_clock_s = running > planned ? 0.0 : planned_s - set_up_s;
    // The last set-up lasts longer if earlier ones were shorter than planned.
    if (running >= planned) by_clock_s = std::max(by_clock_s, length_s - stay_s);
    const double by_signal_s = kLeastUsed * planned_s - used_s;
    plan.left_s = std::max({0.0, by_clock_s, by_signal_s});
    plan.is_disturbed = by_signal_s > std::max(0.0, by_clock_s) &&
                        set_up_s - used_s > (1.0 - kLeastUsed) * planned_s;
    return plan;
}

Word word_of(verdict::State state, const std::optional<PlannedStay>& stay, bool has_contradiction) {
    if (state == verdict::State::no_data) return Word::no_data;
    if (has_contradiction) return Word::look;
    if (state == verdict::State::warming_up) return Word::warming_up;
    if (!stay || stay->plan.is_complete()) return Word::go;
    return stay->plan.needs_next() ? Word::lift : Word::keep_off;
}

Signal signal_of(const verdict::Verdict& verdict, const std::vector<text::Message>& why,
                 const std::optional<PlannedStay>& stay, const std::string& last_site,
                 const std::vector<Contradiction>& contradictions) {
    Signal signal;
    signal.word = word_of(verdict.state, stay, !contradictions.empty());
    signal.text = to_text(signal.word);
    switch (signal.word) {
        case Word::no_data:
            signal.sentence = of_no_data(verdict, why);
            break;
        case Word::warming_up:
            signal.sentence = of_warm_up(verdict, why);
            break;
        case Word::keep_off:
            signal.sentence = of_plan(*stay);
            break;
        case Word::lift:
            signal.sentence = of_plan(*stay);
            signal.buttons = {"setup", "stop"};
            break;
        case Word::go:
            if (stay) {
                signal.sentence = of_plan(*stay);
                signal.buttons = {"stop", "setup"};
                break;
            }
            signal.text = marked("NO STAY RUNS");
            signal.sentence =
                last_site.empty()
                    ? text::message("Set the box down level at a benchmark, then press Start.")
                    : text::message(
                          "The stay at {} has ended. At the next benchmark set the box "
                          "down level, then press Start.",
                          last_site);
            signal.buttons = {"start"};
            break;
        case Word::look:
            signal.look = contradictions.front();
            signal.sentence = signal.look->text;
            if (stay && signal.look->code != kMoved && !signal.look->code.starts_with(kFace))
                signal.sentence += ". " + of_plan(*stay);
            signal.buttons = signal.look->buttons;
            break;
    }
    return signal;
}

}  // namespace a351::daemon::survey
