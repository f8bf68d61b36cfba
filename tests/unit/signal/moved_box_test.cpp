#include "protocol/signal/moved_box.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "tests/unit/signal/made_up_box.hpp"

using namespace a351;
using namespace a351::signal;

namespace {

double seconds_of(const MadeUpBox& box, std::size_t sample) {
    return seconds_between(UtcTime{}, box.samples().at(sample).time);
}

}  // namespace

TEST_CASE("drives, lifts and kicks are found as moves, and the stay ends there",
          "[signal][moved_box]") {
    constexpr int kEach = 67;
    int found[3]{}, ended[3]{};
    for (unsigned seed = 1; seed <= kEach; ++seed) {
        for (int kind = 0; kind < 3; ++kind) {
            MadeUpBox box(1000 * static_cast<unsigned>(kind) + seed);
            box.shake(box.between(5.0, 25.0), 10000.0);
            box.rest(box.between(240.0, 700.0));
            const double moved_s = box.now_s();
            if (kind == 0) {  // carried to the car, driven, set down at another benchmark
                box.shake(box.between(8.0, 25.0), 20000.0);
                box.rest(box.between(0.0, 300.0));
                box.shake(box.between(120.0, 900.0), 20000.0);
                box.place(box.between(-40.0, 40.0));
            } else if (kind == 1) {  // lifted by 10 cm and set down
                box.shake(box.between(8.0, 25.0), 20000.0);
                box.place(0.0);
            } else {  // a kick
                box.shake(2.0, 15000.0);
                box.turn(0.05);
            }
            box.rest(box.between(60.0, 400.0));
            const auto moves = find_box_moves(box.samples());
            if (moves.empty()) continue;
            ++found[kind];
            const StillPart part = choose_still_part(box.samples(), moves);
            CHECK(part.first == 0);
            const double late_s = seconds_of(box, part.end) - moved_s;
            ended[kind] += late_s > -15.0 && late_s < 15.0 ? 1 : 0;
        }
    }
    CAPTURE(found[0], found[1], found[2], ended[0], ended[1], ended[2]);
    for (int kind = 0; kind < 3; ++kind) {
        CHECK(found[kind] >= 0.95 * kEach);
        CHECK(ended[kind] >= 0.95 * kEach);
    }
}

TEST_CASE("a lorry, knocks and hands that do not move the box are no move", "[signal][moved_box]") {
    int told = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        MadeUpBox box(seed);
        box.shake(20.0, 10000.0);
        box.rest(300.0);
        box.shake(60.0, box.between(500.0, 6000.0));
        box.rest(box.between(60.0, 300.0));
        box.shake(box.between(2.0, 10.0), 20000.0);
        box.turn(0.001);  // the ground gives way
        box.rest(200.0);
        box.shake(20.0, 10000.0);
        told += find_box_moves(box.samples()).empty() ? 0 : 1;
    }
    CHECK(told == 0);
}

TEST_CASE("what the operator says was no move does not cut the stay", "[signal][moved_box]") {
    MadeUpBox early(1);
    early.rest(60.0);
    early.shake(80.0, 20000.0);
    early.place(0.0);
    early.rest(300.0);
    const StillPart all{0, early.samples().size()};
    CHECK(answered_stay(early.samples(), std::nullopt).part.first > 0);
    const auto answered = answered_stay(early.samples(), early.samples().back().time);
    CHECK(answered.part == all);
    CHECK(answered.moves.empty());

    MadeUpBox driven(4);  // shaken at its start, without a move
    driven.shake(80.0, 20000.0);
    driven.rest(300.0);
    CHECK(answered_stay(driven.samples(), std::nullopt).part.first > 0);
    CHECK(answered_stay(driven.samples(), driven.samples().back().time).part.first == 0);

    MadeUpBox shaken(2);
    shaken.shake(200.0, 20000.0);
    CHECK(answered_stay(shaken.samples(), std::nullopt).part == StillPart{});
    CHECK(answered_stay(shaken.samples(), shaken.samples().back().time).part ==
          StillPart{0, shaken.samples().size()});

    MadeUpBox late(3);  // answered at once, then carried off
    late.rest(300.0);
    late.shake(80.0, 20000.0);
    late.rest(100.0);
    const UtcTime answer = late.samples().back().time;
    late.shake(20.0, 20000.0);
    late.place(0.0);
    late.rest(100.0);
    const StillPart part = answered_stay(late.samples(), answer).part;
    CHECK(part.first == 0);
    CHECK(late.samples().at(part.end).time > answer);
    CHECK(answered_stay({}, answer).part == StillPart{});
}

TEST_CASE("a start that was pressed too early is moved to where the box stands",
          "[signal][moved_box]") {
    MadeUpBox box(1);
    box.rest(60.0);  // in the parked car
    box.shake(40.0, 20000.0);
    box.place(0.0);
    const double down_s = box.now_s();
    box.rest(500.0);
    const auto moves = find_box_moves(box.samples());
    REQUIRE(moves.size() == 1);
    const StillPart part = choose_still_part(box.samples(), moves);
    CHECK(part.end == box.samples().size());
    CHECK(std::abs(seconds_of(box, part.first) - down_s) <= 14.0);
}

TEST_CASE("a box that is lifted and set down is distinguished from one that is carried off",
          "[signal][moved_box]") {
    constexpr int kEach = 50;
    int lifted = 0, carried = 0, briefly = 0;
    for (unsigned seed = 1; seed <= kEach; ++seed) {
        MadeUpBox box(seed);
        box.rest(box.between(240.0, 500.0));
        box.shake(box.between(8.0, 50.0), 20000.0);
        box.place(box.between(-3.0, 3.0));
        box.rest(box.between(100.0, 150.0));
        briefly += was_only_lifted(box.samples(), find_box_moves(box.samples())) ? 1 : 0;
        box.rest(200.0);
        lifted += was_only_lifted(box.samples(), find_box_moves(box.samples())) ? 1 : 0;

        MadeUpBox late(1000 + seed);  // driven to a benchmark where gravity is nearly the same
        late.rest(300.0);
        late.shake(box.between(130.0, 900.0), 20000.0);
        late.place(box.between(-4.0, 4.0));
        late.rest(400.0);
        carried += was_only_lifted(late.samples(), find_box_moves(late.samples())) ? 1 : 0;
        MadeUpBox other(2000 + seed);  // gravity changes
        other.rest(300.0);
        other.shake(40.0, 20000.0);
        other.place(box.between(15.0, 60.0));
        other.rest(400.0);
        carried += was_only_lifted(other.samples(), find_box_moves(other.samples())) ? 1 : 0;
    }
    CAPTURE(lifted, carried, briefly);
    CHECK(lifted >= 0.95 * kEach);
    CHECK(carried == 0);
    CHECK(briefly == 0);
    MadeUpBox jumped(1);  // at another level without a hand at it
    jumped.rest(300.0);
    jumped.place(0.0);
    jumped.rest(300.0);
    CHECK_FALSE(was_only_lifted(jumped.samples(), find_box_moves(jumped.samples())));
    MadeUpBox still(1);
    still.rest(600.0);
    CHECK_FALSE(was_only_lifted(still.samples(), {}));
}

TEST_CASE("missing samples and records without a pause for comparison have no moves",
          "[signal][moved_box]") {
    MadeUpBox box(1);
    box.rest(38.0);
    CHECK(find_box_moves(box.samples()).empty());
    CHECK(find_box_moves({}).empty());
    CHECK(choose_still_part({}, {}) == StillPart{0, 0});
    box.rest(400.0);
    auto samples = box.samples();
    for (std::size_t i = 50; i < 100; ++i) samples[i].axes[1] = MilliGal(std::nan(""));
    for (std::size_t i = 50; i < 100; ++i) samples[i].shake = MilliGal(std::nan(""));
    CHECK(find_box_moves(samples).empty());
}

TEST_CASE("a stay that was stopped in the car ends before the drive, one in the car is none",
          "[signal][moved_box]") {
    MadeUpBox box(1);
    box.rest(300.0);
    const double moved_s = box.now_s();
    box.shake(90.0, 20000.0);
    const auto part = choose_still_part(box.samples(), find_box_moves(box.samples()));
    CHECK(part.first == 0);
    CHECK(std::abs(seconds_of(box, part.end) - moved_s) <= 14.0);

    MadeUpBox handled(2);
    handled.rest(300.0);
    handled.shake(40.0, 20000.0);  // hands at the end of a stay are usual
    CHECK(choose_still_part(handled.samples(), {}) == StillPart{0, handled.samples().size()});

    MadeUpBox brief(4);
    brief.shake(20.0, 20000.0);
    CHECK(choose_still_part(brief.samples(), {}) == StillPart{0, brief.samples().size()});

    MadeUpBox driven(3);
    driven.shake(600.0, 20000.0);
    CHECK(find_box_moves(driven.samples()).empty());
    CHECK(choose_still_part(driven.samples(), {}) == StillPart{0, 0});
}
