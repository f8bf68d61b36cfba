#include "daemon/survey/move_prompt.hpp"

#include <algorithm>
#include "tests/support/catch.hpp"

#include "tests/unit/signal/made_up_box.hpp"

using namespace a351;
using namespace a351::daemon::survey;
using signal::MadeUpBox;

namespace {

/// Returns the time at which the prompt first appears, s since the begin; negative if it never does.
/// The samples come with the delay of the decimation, 10 s.
double prompted_s(const MadeUpBox& box, double from_s) {
    constexpr double kDelay_s = 10.0;
    const std::span<const signal::MotionSample> all(box.samples());
    for (double now_s = from_s; now_s < box.now_s() + kDelay_s; now_s += 4.0) {
        const auto seen =
            static_cast<std::size_t>(std::max(0.0, now_s - kDelay_s) / signal::kStep_s);
        if (move_prompt(all.first(std::min(seen, all.size())), std::nullopt)) return now_s;
    }
    return -1.0;
}

}  // namespace

TEST_CASE("the operator is asked within a minute of a lift or a kick, and on the way to the car",
          "[survey][moved_box]") {
    constexpr int kEach = 67;
    int in_time[3]{}, asked[3]{};
    for (unsigned seed = 1; seed <= kEach; ++seed)
        for (int kind = 0; kind < 3; ++kind) {
            MadeUpBox box(1000 * static_cast<unsigned>(kind) + seed);
            box.shake(box.between(5.0, 25.0), 10000.0);
            box.rest(box.between(240.0, 400.0));
            const double before_s = box.now_s();
            if (kind == 0) {  // carried, then in the car, whose floor is not level
                box.shake(box.between(8.0, 25.0), 20000.0);
                box.turn(box.between(0.5, 5.0));
            } else if (kind == 1) {
                box.shake(box.between(8.0, 25.0), 20000.0);
                box.place(0.0);
            } else {
                box.shake(2.0, 15000.0);
                box.turn(0.05);
            }
            const double moved_s = box.now_s();
            box.rest(kind == 0 ? box.between(20.0, 300.0) : 100.0);
            if (kind == 0) box.shake(300.0, 20000.0);
            const double at_s = prompted_s(box, before_s);
            asked[kind] += at_s >= 0.0 ? 1 : 0;
            in_time[kind] += at_s >= 0.0 && at_s - moved_s <= 60.0 ? 1 : 0;
        }
    WARN("within 60 s: " << in_time[0] << " drives, " << in_time[1] << " lifts, " << in_time[2]
                         << " kicks of " << kEach << " each; asked at all: " << asked[0] << ", "
                         << asked[1] << ", " << asked[2]);
    CHECK(in_time[0] >= 0.95 * kEach);
    CHECK(in_time[1] >= 0.95 * kEach);
    CHECK(in_time[2] >= 0.95 * kEach);
    for (const int one : asked) CHECK(one >= 0.95 * kEach);
}

TEST_CASE("a lorry that shakes the box for a minute raises no question", "[survey][moved_box]") {
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

TEST_CASE("an answer ends the question, and a later move raises another", "[survey][moved_box]") {
    MadeUpBox box(1);
    box.rest(300.0);
    box.shake(12.0, 20000.0);
    box.place(0.0);
    box.rest(200.0);
    const auto asked = move_prompt(box.samples(), std::nullopt);
    REQUIRE(asked.has_value());
    CHECK_FALSE(asked->is_at_start);
    CHECK(std::abs(seconds_between(UtcTime{}, asked->time) - 300.0) < 20.0);
    CHECK(text_of(*asked).english().find("the box was moved at ") == 0);
    const UtcTime now = box.samples().back().time;
    CHECK_FALSE(move_prompt(box.samples(), now).has_value());
    box.shake(12.0, 20000.0);
    box.place(0.0);
    box.rest(200.0);
    CHECK(move_prompt(box.samples(), now).has_value());
}

TEST_CASE("a start on the way is asked about, and nothing while the box is not at rest",
          "[survey][moved_box]") {
    MadeUpBox box(1);
    box.rest(60.0);
    box.shake(40.0, 20000.0);
    box.place(0.0);
    const double down_s = box.now_s();
    box.rest(300.0);
    const auto asked = move_prompt(box.samples(), std::nullopt);
    REQUIRE(asked.has_value());
    CHECK(asked->is_at_start);
    CHECK(std::abs(seconds_between(UtcTime{}, asked->time) - down_s) <= 14.0);
    CHECK(text_of(*asked).english().find("the box was moved until ") == 0);
    CHECK_FALSE(move_prompt({}, std::nullopt).has_value());
}
