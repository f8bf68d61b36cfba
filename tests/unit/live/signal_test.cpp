#include "daemon/survey/signal.hpp"

#include <vector>
#include "daemon/survey/lasting_word.hpp"
#include "tests/support/catch.hpp"

namespace a351::daemon::survey {
namespace {

using verdict::State;

TEST_CASE("a plan of several set-ups counts each one down") {
    struct Case {
        int planned, running;
        double stay_s, set_up_s, left_s;
        bool needs_next, is_complete;
    };
    constexpr double kLength_s = 720.0;
    for (const Case& one : {Case{2, 1, 230.0, 230.0, 130.0, false, false},
                            {2, 1, 360.0, 360.0, 0.0, true, false},
                            {2, 1, 900.0, 900.0, 0.0, true, false},
                            {2, 2, 400.0, 20.0, 340.0, false, false},
                            {2, 2, 401.0, 360.0, 319.0, false, false},  // the first one had 41 s
                            {2, 2, 720.0, 679.0, 0.0, false, true},
                            {2, 2, 750.0, 360.0, 0.0, false, true},
                            {2, 3, 700.0, 10.0, 170.0, false, false},
                            {2, 3, 950.0, 200.0, 0.0, false, true},
                            {3, 2, 500.0, 240.0, 0.0, true, false},
                            {1, 1, 360.0, 360.0, 360.0, false, false},
                            {1, 1, 720.0, 720.0, 0.0, false, true}}) {
        CAPTURE(one.planned, one.running, one.stay_s, one.set_up_s);
        const SetUpPlan plan = set_up_plan(one.planned, kLength_s, one.running, one.stay_s,
                                           one.set_up_s, one.set_up_s);
        CHECK(plan.left_s == one.left_s);
        CHECK(plan.needs_next() == one.needs_next);
        CHECK(plan.is_complete() == one.is_complete);
    }
}

TEST_CASE("a set-up of which more than half was disturbed needs more time") {
    CHECK_FALSE(set_up_plan(2, 720.0, 3, 700.0, 10.0, 10.0).is_disturbed);  // beyond the plan
    const SetUpPlan plan = set_up_plan(2, 720.0, 1, 360.0, 360.0, 100.0);
    CHECK(plan.left_s == 80.0);
    CHECK(plan.is_disturbed);
    CHECK_FALSE(plan.needs_next());
    CHECK_FALSE(set_up_plan(2, 720.0, 1, 360.0, 360.0, 180.0).is_disturbed);
    CHECK(set_up_plan(2, 720.0, 1, 360.0, 360.0, 180.0).needs_next());
}

SetUpPlan plan_with(int running, double left_s) { return {running, 2, left_s, false}; }

TEST_CASE("one word says what to do now, the worst first") {
    const auto stay = [](int running, double left_s) {
        return PlannedStay{"No.1", plan_with(running, left_s)};
    };
    CHECK(word_of(State::no_data, stay(1, 10.0), true) == Word::no_data);
    CHECK(word_of(State::warming_up, stay(1, 10.0), true) == Word::look);
    CHECK(word_of(State::warming_up, stay(2, 0.0), false) == Word::warming_up);
    // Temperature and noise decide nothing.
    for (const State state : {State::disturbed, State::settling, State::stable}) {
        CHECK(word_of(state, std::nullopt, false) == Word::go);
        CHECK(word_of(state, stay(1, 10.0), false) == Word::keep_off);
        CHECK(word_of(state, stay(1, 0.0), false) == Word::lift);
        CHECK(word_of(state, stay(2, 10.0), false) == Word::keep_off);
        CHECK(word_of(state, stay(2, 0.0), false) == Word::go);
        CHECK(word_of(state, stay(2, 0.0), true) == Word::look);
    }
}

TEST_CASE("the sentence has the reason and what to do, with two buttons at most") {
    const auto said = [](State state, const std::optional<PlannedStay>& stay,
                         const std::vector<Contradiction>& look = {}) {
        return signal_of({state, {}, {}}, {"why"}, stay, "No.5", look);
    };
    const auto sentence = [&](State state, const std::optional<PlannedStay>& stay) {
        return said(state, stay).sentence.english();
    };
    CHECK(sentence(State::no_data, {}) ==
          "No values arrive: why. Check the sensor's plug and its power supply.");
    verdict::Verdict filling;  // The filters fill at a start and after a gap.
    filling.lack = verdict::Lack::values;
    CHECK(signal_of(filling, {"why"}, {}, "", {}).sentence ==
          "Values arrive. The signal needs 20 s of them without a gap.");
    CHECK(sentence(State::warming_up, {}) ==
          "The box is not at its operating temperature yet: why.");
    CHECK(sentence(State::stable, PlannedStay{"No.1", plan_with(1, 129.2)}) ==
          "No.1: set-up 1 of 2, 2:10 left.");
    CHECK(sentence(State::disturbed, PlannedStay{"No.1", plan_with(3, 60.0)}) ==
          "No.1: set-up 3 of 3, 1:00 left.");
    CHECK(sentence(State::stable, PlannedStay{"No.1", plan_with(1, 0.0)}) ==
          "No.1: set-up 1 of 2 is complete. Lift the box, set it down level, then press Next "
          "set-up.");
    CHECK(sentence(State::stable, PlannedStay{"No.1", plan_with(2, 0.0), true}) ==
          "No.1: the reading is complete. Press Stop, then go.");
    CHECK(sentence(State::stable, PlannedStay{"No.1", plan_with(2, 0.0)}) ==
          "No.1: the plan is complete. The reading was not compared with others yet. Press Stop, "
          "then go.");
    CHECK(said(State::stable, {}).text == "NO STAY RUNS");
    CHECK(said(State::stable, PlannedStay{"No.1", plan_with(2, 0.0)}).text == "YOU CAN GO");
    CHECK(sentence(State::stable, {}) ==
          "The stay at No.5 has ended. At the next benchmark set the box down level, then press "
          "Start.");
    CHECK(signal_of({State::stable, {}, {}}, {}, {}, "", {}).sentence ==
          "Set the box down level at a benchmark, then press Start.");
    const Signal look = said(State::stable, {}, {{"moved", "K", "the box was moved", {"a", "b"}}});
    CHECK(look.sentence == "the box was moved");
    CHECK(look.buttons == std::vector<std::string>{"a", "b"});
    CHECK(look.look->key == "K");
    // The sentence has the plan of this stay after a contradiction of another one.
    CHECK(said(State::stable, PlannedStay{"No.1", plan_with(1, 129.2)},
               {{"set_ups", "K", "look", {}}})
              .sentence == "look. No.1: set-up 1 of 2, 2:10 left.");
    verdict::Verdict frozen;
    frozen.lack = verdict::Lack::changes;
    CHECK(signal_of(frozen, {"temperature unchanged"}, {}, "", {}).sentence ==
          "The values cannot be used: temperature unchanged. Switch the sensor off and on.");
}

const UtcTime kFirstSecond{std::chrono::hours(400000)};

UtcTime second(int seconds) { return kFirstSecond + std::chrono::seconds(seconds); }

/// Gives one word a second and returns those that are to be logged.
std::vector<WordChange> logged(LastingWord lasting, const std::vector<Word>& words) {
    std::vector<WordChange> changes;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (const auto change = lasting.take(words[i], second(static_cast<int>(i))))
            changes.push_back(*change);
    return changes;
}

TEST_CASE("a word that lasts five seconds is logged once, with its begin") {
    std::vector words(20, Word::keep_off);
    words.resize(24, Word::lift);
    words.resize(40, Word::go);
    CHECK(logged(LastingWord(), words) ==
          std::vector<WordChange>{{Word::keep_off, second(0)}, {Word::go, second(24)}});
}

TEST_CASE("words that change each second are not logged") {
    std::vector words(20, Word::keep_off);
    for (int i = 0; i < 3600; ++i) words.push_back(i % 2 == 0 ? Word::go : Word::keep_off);
    words.resize(words.size() + 5, Word::go);
    words.resize(words.size() + 20, Word::keep_off);
    CHECK(logged(LastingWord(), words) == std::vector<WordChange>{{Word::keep_off, second(0)}});
}

TEST_CASE("a word that was not shown from its begin is logged from when it was") {
    CHECK(logged(LastingWord(second(12)), std::vector(20, Word::go)) ==
          std::vector<WordChange>{{Word::go, second(12)}});
}

}  // namespace
}  // namespace a351::daemon::survey
