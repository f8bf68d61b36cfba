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
    /// @return the number of troubles then
    std::size_t play(int seconds, std::int32_t z, std::int32_t temperature,
                     std::int32_t shake = 0) {
        return play_counts(seconds, [&](int) -> Counts {
            const auto rustle = static_cast<std::int32_t>(index * 7 % 31) - 15;
            const std::int32_t shaken = index % 2 == 0 ? shake : -shake;
            return {rustle + shaken, -rustle, z + rustle, temperature};
        });
    }
    /// Plays some seconds of the counts of each sample.
    template <class CountsOf>
    std::size_t play_counts(int seconds, CountsOf counts_of) {
        for (int k = 0; k < seconds * kRateHz; ++k, ++index) watch.take(now(), counts_of(k));
        return troubles();
    }
    [[nodiscard]] std::size_t troubles() const { return watch.troubles().size(); }
    /// Returns true if there is one trouble, with this begin.
    [[nodiscard]] bool says(const std::string& begin) const {
        const auto troubles = watch.troubles();
        return troubles.size() == 1 && troubles[0].english().starts_with(begin);
    }
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

TEST_CASE("the norm is judged at rest only, and its trouble lasts until rest contradicts it") {
    Player player;
    CHECK(player.play(60, kOne_g / 2, 100, kOne_g / 8) == 0);
    REQUIRE(player.play(10, kOne_g / 2, 100) == 1);
    CHECK(player.says("the acceleration reads 0.50 g"));
    CHECK(player.play(10, kOne_g / 2, 100, kOne_g / 8) == 1);
    CHECK(player.play(10, kOne_g, 100, kOne_g / 8) == 1);
    CHECK(player.play(10, kOne_g, 100) == 0);
}

TEST_CASE("a norm within 0.9 to 1.1 g is believable") {
    for (const double g : {0.89, 0.91, 1.09, 1.11}) {
        Player player;
        CHECK(player.play(20, static_cast<std::int32_t>(g * kOne_g), 100) ==
              (std::abs(g - 1.0) > 0.1 ? 1 : 0));
    }
    Player beyond;  // An axis beyond the rated range is a trouble in motion, too.
    CHECK(beyond.play(10, 17 * kOne_g, 100, 5 * kOne_g) == 1);
}

TEST_CASE("a temperature outside -40 to +90 degC is a trouble while it lasts") {
    Player player;
    const auto play = [&](double degc) {
        return player.play(10, kOne_g, kProfile.temperature_counts(DegC(degc)));
    };
    CHECK(play(-39.0) == 0);
    CHECK(play(-41.0) == 1);
    const auto texts = player.watch.troubles();
    CHECK(play(-46.0) == 1);
    CHECK(player.watch.troubles() == texts);  // A text does not vary while its trouble lasts.
    CHECK(play(89.0) == 0);
    CHECK(play(91.0) == 1);
}

TEST_CASE("a temperature that keeps its value is frozen after ten minutes") {
    Player player;
    player.play(100, kOne_g, 99);
    CHECK(player.play(600, kOne_g, 100) == 0);
    CHECK(player.play(2, kOne_g, 100) == 1);
    CHECK(player.play(1, kOne_g, 101) == 0);
}

TEST_CASE("a unit with long pauses, or with a coarse counter, has more time") {
    Player paused;
    paused.play(400, kOne_g, 99);
    CHECK(paused.play(1900, kOne_g, 100) == 0);
    CHECK(paused.play(200, kOne_g, 100) == 1);

    const wire::DeviceProfile coarse = with_step(0.0625);  // 16 times as coarse
    Player player(coarse);
    CHECK(player.play(9000, kOne_g, 100) == 0);
    CHECK(player.play(1000, kOne_g, 100) == 1);
}

TEST_CASE("a sensor that does not follow its oven is named, one that approaches it is not") {
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

TEST_CASE("another format that gives the temperature of the oven is named within 10 s") {
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
    CHECK(player.says(
        "the temperature reads -1.9 degC in an oven of 42.0 degC: its conversion does not fit this "
        "sensor; its counts N fit N x -0.0037918 + 34.987 degC, which gives 42.5 degC"));
    CHECK(play(0.0, 20.0).troubles() == 0);   // In no format is it near this oven.
    CHECK(play(30.0, 42.0).troubles() == 0);  // It warms up: 0.03 degC/s.

    player.play(200, kOne_g, -1981);  // The controller is silent: the trouble remains.
    CHECK(player.says("the temperature reads -1.9 degC in an oven of 42.0 degC: its conversion"));
    player.watch.take_oven(player.now(), DegC(-2.0), DegC(42.5));
    CHECK(player.play(1, kOne_g, -1981) == 0);
}

TEST_CASE("counts below a step of the thermometer are named without an oven") {
    wire::DeviceProfile profile = with_step(-0.0037918 / 65536.0);
    profile.temperature_offset_degc = 34.987;
    Player player(profile);
    player.play(10, kOne_g, 43'520);
    CHECK(player.says(
        "the temperature reads 34.98 degC whatever the sensor sends: its conversion does not fit "
        "this sensor; its counts N fit N / 1024 degC, which gives 42.5 degC"));
}

TEST_CASE("an oven that is no longer heard says nothing about the sensor") {
    Player player;
    player.watch.take_oven(kZero, DegC(42.5), DegC(42.5));
    for (int minute = 0; minute < 30; ++minute) player.play(60, kOne_g, 800 + minute % 2);
    CHECK(player.troubles() == 0);
}

TEST_CASE("axes that all keep their values are one trouble") {
    Player player;
    player.play(10, kOne_g, 100);
    player.play_counts(10, [](int) -> Counts { return {100, 200, kOne_g, 100}; });
    CHECK(player.says("no axis changes any more"));
    CHECK(player.play(2, kOne_g, 100) == 0);
}

TEST_CASE("a lowest byte that changes less often than a higher one is another order of bytes") {
    const auto play = [](int step) {  // counts of z from one sample to the next
        Player player;
        player.play_counts(20, [&](int k) -> Counts {
            return {k % 5, k % 7, kOne_g + k * step % 30'000, 100};
        });
        return player.watch.troubles();
    };
    CHECK(play(1).empty());
    CHECK(play(257).empty());
    REQUIRE(play(256).size() == 1);
    CHECK(play(256)[0].english().starts_with("the lowest byte of an axis changes less often"));
}

TEST_CASE("after a long gap, and at the end of the history, the watch begins again") {
    for (const bool is_gap : {true, false}) {
        Player player;
        REQUIRE(player.play(10, kOne_g / 2, 100) == 1);
        if (is_gap) {
            player.index += 11 * kRateHz;
        } else {
            player.watch.end_of_history();
        }
        CHECK(player.play(1, kOne_g / 2, 100) == 0);
    }
}

TEST_CASE("another vertical axis than before the start is a trouble until it is the same again") {
    Player player;
    player.play(100, kOne_g, 100);
    player.watch.end_of_history();
    CHECK(player.play(9, -kOne_g, 100) == 0);
    REQUIRE(player.play(2, -kOne_g, 100) == 1);
    CHECK(player.says("the vertical axis is -z, but before the start it was +z"));
    CHECK(player.play(11, kOne_g, 100) == 0);
    player.play(60, -kOne_g, 100);  // A box is turned over to calibrate it.
    CHECK(player.troubles() == 0);

    player.watch.end_of_history();
    CHECK(player.play(100, -kOne_g, 100) == 0);
}

TEST_CASE(
    "a start that accepts the new vertical axis, a short rest and another unit are no trouble") {
    Player turned;
    turned.play(100, kOne_g, 100);
    turned.watch.end_of_history();
    CHECK(turned.play(11, -kOne_g, 100) == 1);
    turned.watch.end_of_history();
    CHECK(turned.play(100, -kOne_g, 100) == 0);

    Player carried;
    carried.play(100, kOne_g, 100);
    carried.watch.end_of_history();
    carried.play(100, -kOne_g, 100, kOne_g / 20);  // on its side, in a hand
    CHECK(carried.play(20, kOne_g, 100) == 0);

    Player other;
    other.play(100, kOne_g, 100);
    other.watch.end_of_history();
    other.watch.forget();
    CHECK(other.play(100, -kOne_g, 100) == 0);
}

TEST_CASE("a norm that drifts by 1 % a day is a trouble, one that drifts by 0.4 % a day is not") {
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

TEST_CASE("a norm that changes by more than 5 mg within a stance is a trouble") {
    const auto mg = [](double change_mg) {
        return static_cast<std::int32_t>(kOne_g * (1.0 + 1e-3 * change_mg));
    };
    Player player;
    player.play(100, kOne_g, 100);
    player.watch.end_of_history();
    for (const int minute : {0, 1, 2, 3, 4, 5, 6}) player.play(60, mg(4.9), 100 + minute);
    CHECK(player.troubles() == 0);
    CHECK(player.play(250, mg(-5.1), 100) == 0);
    REQUIRE(player.play(60, mg(-5.1), 101) == 1);
    CHECK(player.says("the acceleration at rest has changed by -5.1 mg within a day (limit 5 mg)"));
    CHECK(player.play(60, mg(-4.0), 100) == 0);
    for (const int minute : {0, 1, 2, 3, 4, 5, 6}) player.play(60, -mg(6.0), 100 + minute);
    CHECK(player.troubles() == 0);  // Another stance has another bias.
}

}  // namespace
}  // namespace a351::daemon::believable
