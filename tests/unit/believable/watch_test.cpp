#include "daemon/believable/watch.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

namespace a351::daemon::believable {
namespace {

constexpr int kRateHz = 50;
const UtcTime kZero = *parse_rfc3339("2026-03-14T08:00:00Z");
const wire::DeviceProfile& kProfile = *wire::find_profile("A351");
constexpr std::int32_t kOne_g = 1 << 24;

/// Plays made-up samples to a watch.
struct Player {
    explicit Player(const wire::DeviceProfile& profile = kProfile) : watch(profile, kRateHz) {}

    /// Plays some seconds of a box whose axes rustle by some counts, which is shaken besides.
    void play(int seconds, std::int32_t z, std::int32_t temperature, std::int32_t shake = 0) {
        for (int k = 0; k < seconds * kRateHz; ++k, ++index) {
            const auto rustle = static_cast<std::int32_t>(index * 7 % 31) - 15;
            const std::int32_t shaken = index % 2 == 0 ? shake : -shake;
            watch.take(kZero + from_seconds(static_cast<double>(index) / kRateHz),
                       {rustle + shaken, -rustle, z + rustle, temperature});
        }
    }
    [[nodiscard]] std::size_t troubles() const { return watch.troubles().size(); }
    [[nodiscard]] UtcTime now() const {
        return kZero + from_seconds(static_cast<double>(index) / kRateHz);
    }

    Watch watch;
    std::int64_t index = 0;
};

wire::DeviceProfile with_step(double degc) {
    wire::DeviceProfile profile = kProfile;
    profile.temperature_slope_degc = degc;
    profile.temperature_offset_degc = 20.0;
    return profile;
}

TEST_CASE("the norm is judged at rest only, and its trouble lasts until rest contradicts it",
          "[believable]") {
    Player player;
    player.play(60, kOne_g / 2, 100, kOne_g / 8);
    CHECK(player.troubles() == 0);
    player.play(10, kOne_g / 2, 100);
    REQUIRE(player.troubles() == 1);
    CHECK(player.watch.troubles()[0].english().starts_with("the acceleration reads 0.50 g"));
    player.play(10, kOne_g / 2, 100, kOne_g / 8);
    CHECK(player.troubles() == 1);
    player.play(10, kOne_g, 100, kOne_g / 8);
    CHECK(player.troubles() == 1);
    player.play(10, kOne_g, 100);
    CHECK(player.troubles() == 0);
}

TEST_CASE("a norm within 0.9 to 1.1 g is believable", "[believable]") {
    for (const double g : {0.91, 1.09}) {
        Player player;
        player.play(20, static_cast<std::int32_t>(g * kOne_g), 100);
        CHECK(player.troubles() == 0);
    }
    for (const double g : {0.89, 1.11}) {
        Player player;
        player.play(20, static_cast<std::int32_t>(g * kOne_g), 100);
        CHECK(player.troubles() == 1);
    }
}

TEST_CASE("a temperature outside -40 to +90 degC is a trouble while it lasts", "[believable]") {
    Player player;
    const auto play = [&](double degc) {
        player.play(10, kOne_g, kProfile.temperature_counts(DegC(degc)));
        return player.troubles();
    };
    CHECK(play(-39.0) == 0);
    CHECK(play(-41.0) == 1);
    CHECK(play(89.0) == 0);
    CHECK(play(91.0) == 1);
}

TEST_CASE("a text does not vary while its trouble lasts", "[believable]") {
    Player player;
    player.play(10, kOne_g, kProfile.temperature_counts(DegC(-50.0)));
    const auto texts = player.watch.troubles();
    REQUIRE(texts.size() == 1);
    player.play(10, kOne_g, kProfile.temperature_counts(DegC(-55.0)));
    CHECK(player.watch.troubles() == texts);
}

TEST_CASE("a temperature that keeps its value is frozen after ten minutes", "[believable]") {
    Player player;
    player.play(100, kOne_g, 99);
    player.play(600, kOne_g, 100);
    CHECK(player.troubles() == 0);
    player.play(2, kOne_g, 100);
    CHECK(player.troubles() == 1);
    player.play(1, kOne_g, 101);
    CHECK(player.troubles() == 0);
}

TEST_CASE("a unit with long pauses, or with a coarse counter, has more time", "[believable]") {
    Player paused;
    paused.play(400, kOne_g, 99);
    paused.play(1900, kOne_g, 100);
    CHECK(paused.troubles() == 0);
    paused.play(200, kOne_g, 100);
    CHECK(paused.troubles() == 1);

    const wire::DeviceProfile coarse = with_step(0.0625);  // 16 times as coarse
    Player player(coarse);
    player.play(9000, kOne_g, 100);
    CHECK(player.troubles() == 0);
    player.play(1000, kOne_g, 100);
    CHECK(player.troubles() == 1);
}

TEST_CASE("a sensor that does not follow its oven is named, one that approaches it is not",
          "[believable]") {
    const wire::DeviceProfile profile = with_step(0.01);  // degC = 20 + counts / 100
    const auto play = [&](double degc_per_min, DegC oven, DegC set_point) {
        Player player(profile);
        for (int minute = 0; minute < 20; ++minute)
            for (int half = 0; half < 2; ++half) {
                const double degc = 32.0 + degc_per_min * (minute + 0.5 * half);
                player.watch.take_oven(player.now(), oven, set_point);
                player.play(30, kOne_g,
                            static_cast<std::int32_t>(std::lround(100.0 * (degc - 20.0))) + half);
            }
        return player.troubles();
    };
    CHECK(play(0.01, DegC(42.0), DegC(42.5)) == 1);
    CHECK(play(0.10, DegC(42.0), DegC(42.5)) == 0);
    CHECK(play(0.01, DegC(45.0), DegC(42.5)) == 0);  // It is hotter outside.
    CHECK(play(0.01, DegC(36.5), DegC(36.0)) == 0);
}

TEST_CASE("another format that gives the temperature of the oven is named within 10 s",
          "[believable]") {
    // The format of the M-A352AD10, which the profile reads as counts / 1024: -1.9 degC.
    wire::DeviceProfile profile = with_step(1.0 / 1024.0);
    profile.temperature_offset_degc = 0.0;
    const auto play = [&](double counts_per_s, double oven_degc) {
        Player player(profile);
        for (int second = 0; second < 10; ++second) {
            player.watch.take_oven(player.now(), DegC(oven_degc), DegC(42.5));
            player.play(1, kOne_g, -1981 + static_cast<std::int32_t>(counts_per_s * second));
        }
        return player;
    };
    Player player = play(0.0, 42.0);
    const auto troubles = player.watch.troubles();
    REQUIRE(troubles.size() == 1);
    CHECK(troubles[0].english().starts_with(
        "the temperature reads -1.9 degC in an oven of 42.0 degC: its conversion does not fit this "
        "sensor; its counts N fit N x -0.0037918 + 34.987 degC, which gives 42.5 degC"));
    CHECK(play(0.0, 20.0).troubles() == 0);   // In no format is it near this oven.
    CHECK(play(30.0, 42.0).troubles() == 0);  // It warms up: 0.03 degC/s.

    player.play(200, kOne_g, -1981);  // The controller is silent: the trouble remains.
    CHECK(player.watch.troubles() == troubles);
    player.watch.take_oven(player.now(), DegC(-2.0), DegC(42.5));
    player.play(1, kOne_g, -1981);
    CHECK(player.troubles() == 0);
}

TEST_CASE("counts below a step of the thermometer are named without an oven", "[believable]") {
    wire::DeviceProfile profile = with_step(-0.0037918 / 65536.0);
    profile.temperature_offset_degc = 34.987;
    Player player(profile);
    player.play(10, kOne_g, 43'520);
    const auto troubles = player.watch.troubles();
    REQUIRE(troubles.size() == 1);
    CHECK(troubles[0].english().starts_with(
        "the temperature reads 34.98 degC whatever the sensor sends: its conversion does not fit "
        "this sensor; its counts N fit N / 1024 degC, which gives 42.5 degC"));
}

TEST_CASE("an oven that is no longer heard says nothing about the sensor", "[believable]") {
    Player player;
    player.watch.take_oven(kZero, DegC(42.5), DegC(42.5));
    for (int minute = 0; minute < 30; ++minute) player.play(60, kOne_g, 800 + minute % 2);
    CHECK(player.troubles() == 0);
}

TEST_CASE("a dead axis is named and explains the norm", "[believable]") {
    Player player;
    player.play(10, kOne_g, 100);
    for (int k = 0; k < 10 * kRateHz; ++k, ++player.index)
        player.watch.take(player.now(), {k % 5, k % 7, 0, 100 + k % 3});
    const auto troubles = player.watch.troubles();
    REQUIRE(troubles.size() == 1);
    CHECK(troubles[0].english().starts_with("axis z does not change"));
}

TEST_CASE("axes that all keep their values are one trouble", "[believable]") {
    Player player;
    player.play(10, kOne_g, 100);
    for (int k = 0; k < 10 * kRateHz; ++k, ++player.index)
        player.watch.take(player.now(), {100, 200, kOne_g, 100});
    const auto troubles = player.watch.troubles();
    REQUIRE(troubles.size() == 1);
    CHECK(troubles[0].english().starts_with("no axis changes any more"));
    player.play(2, kOne_g, 100);
    CHECK(player.troubles() == 0);
}

TEST_CASE("a lowest byte that changes less often than a higher one is another order of bytes",
          "[believable]") {
    const auto play = [](int step) {  // counts of z from one sample to the next
        Player player;
        for (int k = 0; k < 20 * kRateHz; ++k, ++player.index)
            player.watch.take(player.now(), {k % 5, k % 7, kOne_g + k * step % 30'000, 100});
        return player.watch.troubles();
    };
    CHECK(play(1).empty());
    CHECK(play(257).empty());
    REQUIRE(play(256).size() == 1);
    CHECK(play(256)[0].english().starts_with("the lowest byte of an axis changes less often"));
}

TEST_CASE("an axis beyond the rated range is a trouble in motion, too", "[believable]") {
    Player player;
    player.play(10, 17 * kOne_g, 100, 5 * kOne_g);
    CHECK(player.troubles() == 1);
}

TEST_CASE("after a long gap, and at the end of the history, the watch begins again",
          "[believable]") {
    for (const bool is_gap : {true, false}) {
        Player player;
        player.play(10, kOne_g / 2, 100);
        REQUIRE(player.troubles() == 1);
        if (is_gap) {
            player.index += 11 * kRateHz;
        } else {
            player.watch.end_of_history();
        }
        player.play(1, kOne_g / 2, 100);
        CHECK(player.troubles() == 0);
    }
}

TEST_CASE("another vertical axis than before the start is a trouble until it is the same again",
          "[believable]") {
    Player player;
    player.play(100, kOne_g, 100);
    player.watch.end_of_history();
    player.play(9, -kOne_g, 100);
    CHECK(player.troubles() == 0);
    player.play(2, -kOne_g, 100);
    REQUIRE(player.troubles() == 1);
    CHECK(player.watch.troubles()[0].english().starts_with(
        "the vertical axis is -z, but before the start it was +z"));
    player.play(11, kOne_g, 100);
    CHECK(player.troubles() == 0);
    player.play(60, -kOne_g, 100);  // A box is turned over to calibrate it.
    CHECK(player.troubles() == 0);

    player.watch.end_of_history();
    player.play(100, -kOne_g, 100);
    CHECK(player.troubles() == 0);
}

TEST_CASE(
    "a start that accepts the new vertical axis, a short rest and another unit are no trouble",
    "[believable]") {
    Player turned;
    turned.play(100, kOne_g, 100);
    turned.watch.end_of_history();
    turned.play(11, -kOne_g, 100);
    CHECK(turned.troubles() == 1);
    turned.watch.end_of_history();
    turned.play(100, -kOne_g, 100);
    CHECK(turned.troubles() == 0);

    Player carried;
    carried.play(100, kOne_g, 100);
    carried.watch.end_of_history();
    carried.play(100, -kOne_g, 100, kOne_g / 20);  // on its side, in a hand
    carried.play(20, kOne_g, 100);
    CHECK(carried.troubles() == 0);

    Player other;
    other.play(100, kOne_g, 100);
    other.watch.end_of_history();
    other.watch.forget();
    other.play(100, -kOne_g, 100);
    CHECK(other.troubles() == 0);
}

TEST_CASE("a norm that drifts by 1 % a day is a trouble, one that drifts by 0.4 % a day is not",
          "[believable]") {
    const auto days_until_trouble = [](double mg_per_day) {
        Player player;
        for (double day = 0.0; day < 2.0; day += 1.0 / 1440.0) {
            if (player.troubles() > 0) return day;
            player.play(60, static_cast<std::int32_t>(kOne_g * (1.0 + 1e-3 * mg_per_day * day)),
                        100 + static_cast<std::int32_t>(std::lround(1440.0 * day)) % 2);
        }
        return 2.0;
    };
    CHECK(days_until_trouble(10.0) < 0.51);
    CHECK(days_until_trouble(-10.0) < 0.51);
    CHECK(days_until_trouble(4.0) == 2.0);
}

TEST_CASE("a norm that changes by more than 5 mg within a stance is a trouble", "[believable]") {
    const auto mg = [](double change_mg) {
        return static_cast<std::int32_t>(kOne_g * (1.0 + 1e-3 * change_mg));
    };
    Player player;
    player.play(100, kOne_g, 100);
    player.watch.end_of_history();
    for (const int minute : {0, 1, 2, 3, 4, 5, 6}) player.play(60, mg(4.9), 100 + minute);
    CHECK(player.troubles() == 0);
    player.play(250, mg(-5.1), 100);
    CHECK(player.troubles() == 0);
    player.play(60, mg(-5.1), 101);
    REQUIRE(player.troubles() == 1);
    CHECK(player.watch.troubles()[0].english().starts_with(
        "the acceleration at rest has changed by -5.1 mg within a day (limit 5 mg)"));
    player.play(60, mg(-4.0), 100);
    CHECK(player.troubles() == 0);
    for (const int minute : {0, 1, 2, 3, 4, 5, 6}) player.play(60, -mg(6.0), 100 + minute);
    CHECK(player.troubles() == 0);  // Another stance has another bias.
}

}  // namespace
}  // namespace a351::daemon::believable
