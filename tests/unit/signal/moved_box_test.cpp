#include "protocol/signal/moved_box.hpp"

#include <cmath>
#include <random>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::signal;

namespace {

constexpr double kStep_s = 2.0;
constexpr double kDeg_mgal = 980665.0 * 3.141592653589793 / 180.0;

/// A box on quiet ground: 10 mGal of noise on each decimated axis, a shake of 60 mGal.
class MadeUpBox {
public:
    explicit MadeUpBox(unsigned seed) : random_(seed) {}

    /// Adds time at rest.
    void rest(double seconds) { add(seconds, 60.0, 10.0); }
    /// Adds shaking, as half peak to peak of the raw samples, and what the filter lets through.
    void shake(double seconds, double peak_mgal) { add(seconds, peak_mgal, 0.01 * peak_mgal); }
    /// Turns the box by this angle, in a random direction.
    void turn(double deg) {
        const double direction = 6.283 * std::uniform_real_distribution<double>()(random_);
        x_mgal_ += deg * kDeg_mgal * std::cos(direction);
        y_mgal_ += deg * kDeg_mgal * std::sin(direction);
    }
    /// Levels the box as an operator does, within 0.1 deg, at another gravity.
    void place(double gravity_mgal) {
        std::normal_distribution<double> tilt_mgal(0.0, 0.1 * kDeg_mgal);
        x_mgal_ = tilt_mgal(random_);
        y_mgal_ = tilt_mgal(random_);
        gravity_mgal_ += gravity_mgal;
    }
    double between(double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random_);
    }

    [[nodiscard]] const std::vector<MotionSample>& samples() const { return samples_; }
    /// Returns the time since the begin, s.
    [[nodiscard]] double now_s() const { return kStep_s * static_cast<double>(samples_.size()); }

private:
    void add(double seconds, double shake_mgal, double noise_mgal) {
        std::normal_distribution<double> normal;
        const auto count = static_cast<std::size_t>(seconds / kStep_s);
        for (std::size_t i = 0; i < count; ++i) {
            const double z_mgal =
                std::sqrt(gravity_mgal_ * gravity_mgal_ - x_mgal_ * x_mgal_ - y_mgal_ * y_mgal_);
            samples_.push_back({UtcTime{} + from_seconds(now_s()),
                                {MilliGal(x_mgal_ + noise_mgal * normal(random_)),
                                 MilliGal(y_mgal_ + noise_mgal * normal(random_)),
                                 MilliGal(z_mgal + 0.2 * noise_mgal * normal(random_))},
                                MilliGal(shake_mgal)});
        }
    }

    std::mt19937_64 random_;
    double x_mgal_ = 0.0, y_mgal_ = 0.0, gravity_mgal_ = 979900e0;
    std::vector<MotionSample> samples_;
};

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
            const double late_s = seconds_of(box, part.behind) - moved_s;
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
    CHECK(part.behind == box.samples().size());
    CHECK(std::abs(seconds_of(box, part.first) - down_s) <= 14.0);
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
    CHECK(std::abs(seconds_of(box, part.behind) - moved_s) <= 14.0);

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
