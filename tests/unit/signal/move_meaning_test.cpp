#include "protocol/signal/move_meaning.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "tests/unit/signal/made_up_box.hpp"

using namespace a351;
using namespace a351::signal;

namespace {

double seconds_of(const MadeUpBox& box, std::size_t sample) {
    return seconds_between(UtcTime{}, box.samples().at(sample).time);
}

/// Returns the judgement of a box as a set-up from its first sample to now.
JudgedSetUp judged(const MadeUpBox& box, SetUpEnd ended_by = SetUpEnd::stop,
                   bool began_with_next_set_up = false) {
    return judge_moves(box.samples(), {.start = UtcTime{},
                                       .end = UtcTime{} + from_seconds(box.now_s()),
                                       .ended_by = ended_by,
                                       .began_with_next_set_up = began_with_next_set_up});
}

/// Returns the judgement after the operator's answer.
JudgedSetUp answered(const MadeUpBox& box, UtcTime answer) {
    return judge_moves(box.samples(), {.start = UtcTime{},
                                       .end = UtcTime{} + from_seconds(box.now_s()),
                                       .not_moved_until = answer});
}

StillPart whole(const MadeUpBox& box) { return {0, box.samples().size()}; }

/// Adds the lifting of the box, its levelling and then time at rest.
void lift(MadeUpBox& box, double rest_s, double levelling_s = 40.0) {
    box.shake(levelling_s, 20000.0);
    box.place(1.0);
    box.rest(rest_s);
}

}  // namespace

TEST_CASE("a stay ends where the box is driven off, lifted or kicked") {
    constexpr int kEach = 67;
    int ended[3]{};
    for (unsigned seed = 1; seed <= kEach; ++seed) {
        for (int kind = 0; kind < 3; ++kind) {
            const MadeUpBox box = MadeUpBox::that_moves(kind, seed);
            const StillPart part = judged(box).part;
            CHECK(part.first == 0);
            if (part == whole(box)) continue;
            ended[kind] += std::abs(seconds_of(box, part.end) - box.moved_s()) < 15.0 ? 1 : 0;
        }
    }
    CAPTURE(ended[0], ended[1], ended[2]);
    for (const int one : ended) CHECK(one >= 0.95 * kEach);
}

TEST_CASE("a move up to ten minutes before Next set-up is the change of set-ups") {
    for (const double before_s : {24.0, 60.0, 120.0, 300.0, 594.0, 606.0}) {
        CAPTURE(before_s);
        MadeUpBox box(1, 360.0);
        lift(box, before_s - 20.0, 20.0);
        const auto of = judged(box, SetUpEnd::next_set_up);
        if (before_s > 600.0) {
            CHECK(of.at_end == MoveMeaning::forgotten_set_up);
        } else if (before_s < 40.0) {  // not at rest for long enough to see a move
            CHECK(of.part == whole(box));
        } else {
            CHECK(of.at_end == MoveMeaning::change_of_set_ups);
            CHECK(std::abs(seconds_of(box, of.part.end) - 360.0) < 15.0);
            CHECK(of.forgotten.empty());
        }
        CHECK(of.at_start == MoveMeaning::none);
    }
    MadeUpBox kicked(2, 360.0);  // and set down at another level without a hand that shakes it
    kicked.turn(0.05);
    kicked.rest(120.0);
    CHECK(judged(kicked, SetUpEnd::next_set_up).at_end == MoveMeaning::change_of_set_ups);
}

TEST_CASE("a move with a drive is no change of set-ups") {
    for (const double drive_s : {116.0, 124.0}) {
        CAPTURE(drive_s);
        MadeUpBox before(1, 360.0), after(1, 30.0);
        lift(before, 60.0, drive_s);
        CHECK(judged(before, SetUpEnd::next_set_up).at_end ==
              (drive_s > 120.0 ? MoveMeaning::late_stop : MoveMeaning::change_of_set_ups));
        lift(after, 360.0, drive_s);
        CHECK(judged(after, SetUpEnd::stop, true).at_start ==
              (drive_s > 120.0 ? MoveMeaning::early_start : MoveMeaning::change_of_set_ups));
    }
    MadeUpBox levelled(2,
                       360.0);  // a minute at rest ends a drive, and levelling in two goes is none
    lift(levelled, 90.0, 70.0);
    lift(levelled, 90.0, 70.0);
    const auto of = judged(levelled, SetUpEnd::next_set_up);
    CHECK(of.at_end == MoveMeaning::change_of_set_ups);
    CHECK(std::abs(seconds_of(levelled, of.part.end) - 360.0) < 15.0);
}

TEST_CASE("a move up to a minute after Next set-up is the change of set-ups") {
    for (const double after_s : {20.0, 59.0, 61.0}) {
        CAPTURE(after_s);
        MadeUpBox box(1);
        const double first_s = std::fmod(after_s, 2.0);  // of the first sample after the press
        box.rest(after_s - first_s);
        lift(box, 360.0, 70.0);
        const auto of = judge_moves(box.samples(), {.start = UtcTime{} - from_seconds(first_s),
                                                    .end = UtcTime{} + from_seconds(box.now_s()),
                                                    .began_with_next_set_up = true});
        CHECK(of.at_start ==
              (after_s > 60.0 ? MoveMeaning::early_start : MoveMeaning::change_of_set_ups));
        CHECK(of.at_end == MoveMeaning::none);
        CHECK(std::abs(seconds_of(box, of.part.first) + first_s - after_s - 70.0) <= 20.0);
        CHECK(judged(box).at_start == MoveMeaning::early_start);  // the stay itself began too early
    }
}

TEST_CASE("an earlier move in a set-up that Next set-up ends is not part of the change") {
    MadeUpBox lifted(1, 300.0), kicked(1, 300.0);
    lift(lifted, 240.0);
    lift(lifted, 60.0);
    const auto of = judged(lifted, SetUpEnd::next_set_up);
    CHECK(of.at_end == MoveMeaning::forgotten_set_up);
    REQUIRE(of.forgotten.size() == 1);
    CHECK(std::abs(seconds_of(lifted, of.forgotten.front().before) - 300.0) < 15.0);
    kicked.shake(2.0, 15000.0);
    kicked.turn(0.05);
    kicked.rest(240.0);
    lift(kicked, 60.0);
    CHECK(judged(kicked, SetUpEnd::next_set_up).at_end == MoveMeaning::late_stop);
}

TEST_CASE("a lift and a minute at rest before the stop are a forgotten set-up, no drive is one") {
    constexpr int kEach = 50;
    int lifted = 0, carried = 0, briefly = 0;
    const auto is_forgotten = [](const MadeUpBox& box, SetUpEnd ended_by = SetUpEnd::stop) {
        return judged(box, ended_by).at_end == MoveMeaning::forgotten_set_up ? 1 : 0;
    };
    for (unsigned seed = 1; seed <= kEach; ++seed) {
        MadeUpBox box(seed);
        box.rest(box.between(240.0, 500.0));
        box.shake(box.between(8.0, 50.0), 20000.0);
        box.place(box.between(-3.0, 3.0));
        box.rest(box.between(40.0, 65.0));
        briefly += is_forgotten(box);
        box.rest(30.0);
        lifted += is_forgotten(box);
        CHECK_FALSE(is_forgotten(box, SetUpEnd::not_stopped));

        MadeUpBox late(1000 + seed);  // driven to a benchmark where gravity is nearly the same
        late.rest(300.0);
        late.shake(box.between(130.0, 900.0), 20000.0);
        late.place(box.between(-4.0, 4.0));
        late.rest(400.0);
        carried += is_forgotten(late);
        MadeUpBox other(2000 + seed);  // gravity changes
        other.rest(300.0);
        other.shake(40.0, 20000.0);
        other.place(box.between(15.0, 60.0));
        other.rest(400.0);
        carried += is_forgotten(other);
    }
    CAPTURE(lifted, carried, briefly);
    CHECK(lifted >= 0.95 * kEach);
    CHECK(carried == 0);
    CHECK(briefly == 0);
    MadeUpBox jumped(1, 300.0);  // at another level without a hand at it
    jumped.place(0.0);
    jumped.rest(300.0);
    CHECK(judged(jumped).at_end == MoveMeaning::late_stop);
    MadeUpBox still(1, 600.0);
    CHECK(judged(still).part == whole(still));
}

TEST_CASE(
    "while a set-up runs a lift may be the change until the box was at rest for three minutes") {
    const auto meaning = [](const MadeUpBox& box) { return judged(box, SetUpEnd::running).at_end; };
    MadeUpBox box(1, 360.0);
    lift(box, 170.0);
    CHECK(meaning(box) == MoveMeaning::may_be_change);
    box.rest(40.0);
    CHECK(meaning(box) == MoveMeaning::forgotten_set_up);
    MadeUpBox driven(2, 360.0);
    lift(driven, 60.0);
    driven.shake(70.0, 20000.0);
    CHECK(meaning(driven) == MoveMeaning::may_be_change);
    driven.shake(60.0, 20000.0);
    CHECK(meaning(driven) == MoveMeaning::late_stop);
    MadeUpBox carried(3, 360.0);
    carried.shake(100.0, 20000.0);
    CHECK(meaning(carried) == MoveMeaning::may_be_change);
    carried.shake(40.0, 20000.0);
    CHECK(meaning(carried) == MoveMeaning::late_stop);
}

TEST_CASE("what the operator says was no move does not cut the stay") {
    MadeUpBox early(1, 60.0);
    lift(early, 300.0, 80.0);
    CHECK(judged(early).part.first > 0);
    CHECK(answered(early, early.samples().back().time).part == whole(early));

    MadeUpBox driven(4);  // shaken at its start, without a move
    driven.shake(80.0, 20000.0);
    driven.rest(300.0);
    CHECK(judged(driven).part.first > 0);
    CHECK(answered(driven, driven.samples().back().time).part == whole(driven));

    MadeUpBox shaken(2);
    shaken.shake(200.0, 20000.0);
    CHECK(judged(shaken).part == StillPart{});
    CHECK(answered(shaken, shaken.samples().back().time).part == whole(shaken));

    MadeUpBox late(3, 300.0);  // answered at once, then carried off
    late.shake(80.0, 20000.0);
    late.rest(100.0);
    const UtcTime answer = late.samples().back().time;
    CHECK(answered(late, answer).part == whole(late));
    lift(late, 100.0, 20.0);
    const StillPart part = answered(late, answer).part;
    CHECK(part.first == 0);
    CHECK(part.end < late.samples().size());
    CHECK(late.samples().at(part.end).time > answer);
    CHECK(judge_moves({}, {.start = answer, .end = answer}).part == StillPart{});
}

TEST_CASE("a stay that was started or stopped in the car has no drive, one in the car is none") {
    MadeUpBox early(1, 60.0);
    lift(early, 500.0);
    const auto begun = judged(early);
    CHECK(begun.at_start == MoveMeaning::early_start);
    CHECK(begun.part.end == early.samples().size());
    CHECK(std::abs(seconds_of(early, begun.part.first) - 100.0) <= 14.0);

    MadeUpBox box(1, 300.0);
    box.shake(90.0, 20000.0);
    const auto of = judged(box);
    CHECK(of.at_end == MoveMeaning::late_stop);
    CHECK(of.part.first == 0);
    CHECK(std::abs(seconds_of(box, of.part.end) - 300.0) <= 14.0);

    MadeUpBox handled(2, 300.0);
    handled.shake(40.0, 20000.0);  // hands at the end of a stay are usual
    CHECK(judged(handled).part == whole(handled));

    MadeUpBox brief(4);
    brief.shake(20.0, 20000.0);
    CHECK(judged(brief).part == whole(brief));

    MadeUpBox driven(3);
    driven.shake(600.0, 20000.0);
    CHECK(judged(driven).part == StillPart{});
}
