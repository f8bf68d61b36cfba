#include "daemon/survey/move_prompt.hpp"

#include <algorithm>
#include "tests/support/catch.hpp"
#include "tests/unit/signal/made_up_box.hpp"

using namespace a351;
using namespace a351::daemon::survey;
using signal::MadeUpBox;

namespace {

/// Returns what is asked about a set-up that runs since the first sample.
std::optional<MovePrompt> asked_of(std::span<const signal::MotionSample> samples,
                                   std::optional<UtcTime> not_moved_until = {}) {
    return move_prompt(samples, {.start = UtcTime{},
                                 .end = UtcTime{} + from_seconds(signal::kStep_s) *
                                                        static_cast<std::int64_t>(samples.size()),
                                 .ended_by = signal::SetUpEnd::running,
                                 .not_moved_until = not_moved_until});
}

/// Returns the time at which the prompt first appears, s since the begin; negative if it never does.
/// The samples come with the delay of the decimation, 10 s.
double prompted_s(const MadeUpBox& box, double from_s) {
    constexpr double kDelay_s = 10.0;
    const std::span<const signal::MotionSample> all(box.samples());
    for (double now_s = from_s; now_s < box.now_s() + kDelay_s; now_s += 4.0) {
        const auto seen =
            static_cast<std::size_t>(std::max(0.0, now_s - kDelay_s) / signal::kStep_s);
        if (asked_of(all.first(std::min(seen, all.size())))) return now_s;
    }
    return -1.0;
}

}  // namespace

TEST_CASE(
    "the operator is asked within a minute of a kick, three minutes at rest after a lift, and on "
    "the way to the car") {
    constexpr int kEach = 67;
    int in_time[3]{}, early[3]{};
    for (unsigned seed = 1; seed <= kEach; ++seed)
        for (int kind = 0; kind < 3; ++kind) {
            MadeUpBox box(1000 * static_cast<unsigned>(kind) + seed);
            box.shake(box.between(5.0, 25.0), 10000.0);
            box.rest(box.between(240.0, 400.0));
            const double before_s = box.now_s();
            double at_rest_s = 0.0;
            if (kind == 0) {  // carried, then in the car, whose floor is not level
                box.shake(box.between(8.0, 25.0), 20000.0);
                box.turn(box.between(0.5, 5.0));
                at_rest_s = box.between(20.0, 300.0);
                box.rest(at_rest_s);
                box.shake(300.0, 20000.0);
            } else if (kind == 1) {
                box.shake(box.between(8.0, 25.0), 20000.0);
                box.place(0.0);
                box.rest(300.0);
            } else {
                box.shake(2.0, 15000.0);
                box.turn(0.05);
                box.rest(100.0);
            }
            const double at_s = prompted_s(box, before_s) - before_s;
            // Handling, the reach of the decimation, and three minutes at rest or two of the drive.
            const double latest_s =
                kind == 2 ? 60.0 : 250.0 + (at_rest_s > 180.0 ? 0.0 : at_rest_s);
            in_time[kind] += at_s >= 0.0 && at_s <= latest_s ? 1 : 0;
            early[kind] += at_s < (kind == 2 ? 0.0 : 120.0) ? 1 : 0;
        }
    CAPTURE(in_time[0], in_time[1], in_time[2]);
    for (const int one : in_time) CHECK(one >= 0.95 * kEach);
    CHECK(early[0] == 0);
    CHECK(early[1] == 0);
}

TEST_CASE("nothing is asked about a lift that Next set-up follows within three minutes") {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        MadeUpBox box(seed);
        box.rest(360.0);
        box.shake(box.between(10.0, 60.0), 20000.0);
        box.place(0.0);
        box.rest(box.between(0.0, 60.0));
        box.shake(box.between(0.0, 20.0), 20000.0);  // levelled again
        box.turn(0.03);
        box.rest(100.0);
        CHECK(prompted_s(box, 30.0) < 0.0);
    }
}

TEST_CASE("a lorry that shakes the box for a minute raises no question") {
    int asked = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        MadeUpBox box(seed);
        box.shake(20.0, 10000.0);
        box.rest(300.0);
        box.shake(60.0, box.between(500.0, 6000.0));
        box.rest(200.0);
        asked += prompted_s(box, 30.0) >= 0.0 ? 1 : 0;
    }
    WARN("asked after " << asked << " of 200 lorries");
    CHECK(asked <= 10);  // 5 %
}

TEST_CASE("an answer ends the question, and a later move raises another") {
    MadeUpBox box(1);
    box.rest(300.0);
    box.shake(12.0, 20000.0);
    box.place(0.0);
    box.rest(220.0);
    const auto asked = asked_of(box.samples());
    REQUIRE(asked.has_value());
    CHECK_FALSE(asked->is_at_start);
    CHECK(asked->is_set_up);
    CHECK(std::abs(seconds_between(UtcTime{}, asked->time) - 300.0) < 20.0);
    CHECK(text_of(*asked).english().find("the box was lifted and set down at ") == 0);
    const UtcTime now = box.samples().back().time;
    CHECK_FALSE(asked_of(box.samples(), now).has_value());
    box.shake(140.0, 20000.0);
    const auto carried = asked_of(box.samples(), now);
    REQUIRE(carried.has_value());
    CHECK(text_of(*carried).english().find("the box was moved at ") == 0);
}

TEST_CASE("a start on the way is asked about, and nothing while the box is not at rest") {
    MadeUpBox box(1);
    box.rest(60.0);
    box.shake(40.0, 20000.0);
    box.place(0.0);
    const double down_s = box.now_s();
    box.rest(300.0);
    const auto asked = asked_of(box.samples());
    REQUIRE(asked.has_value());
    CHECK(asked->is_at_start);
    CHECK(std::abs(seconds_between(UtcTime{}, asked->time) - down_s) <= 14.0);
    CHECK(text_of(*asked).english().find("the box was moved until ") == 0);
    CHECK_FALSE(asked_of({}).has_value());
}
