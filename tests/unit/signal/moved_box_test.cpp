#include "protocol/signal/moved_box.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "tests/unit/signal/made_up_box.hpp"

using namespace a351;
using namespace a351::signal;

TEST_CASE("drives, lifts and kicks are found as moves") {
    constexpr int kEach = 67;
    int found[3]{};
    for (unsigned seed = 1; seed <= kEach; ++seed)
        for (int kind = 0; kind < 3; ++kind)
            found[kind] +=
                find_box_moves(MadeUpBox::that_moves(kind, seed).samples()).empty() ? 0 : 1;
    CAPTURE(found[0], found[1], found[2]);
    for (const int one : found) CHECK(one >= 0.95 * kEach);
}

TEST_CASE("a lorry, knocks and hands that do not move the box are no move") {
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

TEST_CASE("missing samples and records without a pause for comparison have no moves") {
    MadeUpBox box(1);
    box.rest(38.0);
    CHECK(find_box_moves(box.samples()).empty());
    CHECK(find_box_moves({}).empty());
    box.rest(400.0);
    auto samples = box.samples();
    for (std::size_t i = 50; i < 100; ++i) samples[i].axes[1] = MilliGal(std::nan(""));
    for (std::size_t i = 50; i < 100; ++i) samples[i].shake = MilliGal(std::nan(""));
    CHECK(find_box_moves(samples).empty());
}
