#include "corrector/reading/vertical_axis.hpp"

#include <algorithm>
#include <array>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::reading;

namespace {

const UtcTime kDayStart = *parse_rfc3339("2026-05-01T00:00:00Z");

/// A sensor whose axes BN1, BN2, BNZ sense these values, in g, on the way to a stay and during it.
struct Mounted {
    std::array<double, 3> sensed_g;
    std::array<std::size_t, 3> order;  ///< Order of the channels in the file.
    std::array<double, 3> dip_deg{0.0, 0.0, -90.0};
    bool turns_later = false;  ///< In the last two windows.

    std::vector<archive::ChannelData> samples = std::vector<archive::ChannelData>(3);
    corrector::archive_series::Epoch epoch = {};
    text::Message warning = {};

    void look() {
        const std::array<const char*, 3> codes{"BN1", "BN2", "BNZ"};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t axis = order[k];
            const double counts = sensed_g[axis] * 9.80665 * 1e5;
            archive::Segment segment{50.0, {}, {{0, kDayStart}}};
            segment.counts.assign(30'000, static_cast<std::int32_t>(counts));
            std::fill_n(segment.counts.begin(), 15'000, 980'665);  // on the way: not looked at
            if (turns_later)
                std::for_each(segment.counts.begin() + 22'500, segment.counts.end(),
                              [](std::int32_t& count) { count = -count; });
            samples[k].segments = {segment};
            epoch.channels.push_back({.code = codes[axis],
                                      .gain = 1e-5,
                                      .unit = "m/s**2",
                                      .dip_deg = dip_deg[axis]});
        }
        // The first quarter of the time at the stay is a window, and so on.
        std::vector<OccupationWindow> windows(4);
        for (std::size_t k = 0; k < windows.size(); ++k) {
            windows[k].start = kDayStart + from_seconds(300.0 + 75.0 * static_cast<double>(k));
            windows[k].end = windows[k].start + from_seconds(75.0);
        }
        warning = put_vertical_last(samples, epoch, windows, "station.xml");
    }
};

constexpr std::array<std::array<std::size_t, 3>, 3> kOrders{{{0, 1, 2}, {2, 0, 1}, {1, 2, 0}}};

}  // namespace

TEST_CASE("the vertical axis is found in six mountings and three orders of the channels") {
    const std::array<const char*, 3> codes{"BN1", "BN2", "BNZ"};
    for (const auto& order : kOrders)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const double sign : {1.0, -1.0}) {
                Mounted sensor{{0.002, -0.003, 0.004}, order};
                sensor.sensed_g[axis] = sign * 1.0018;
                sensor.look();
                CAPTURE(codes[axis], sign, sensor.warning);
                CHECK(sensor.epoch.channels[2].code == codes[axis]);
                std::vector<std::string> horizontal;
                for (const std::size_t other : order)
                    if (other != axis) horizontal.emplace_back(codes[other]);
                CHECK(sensor.epoch.channels[0].code == horizontal[0]);
                CHECK(sensor.epoch.channels[1].code == horizontal[1]);
                CHECK(std::abs(sensor.samples[2].segments[0].counts.back()) > 900'000);
                const bool is_upside_down =
                    sensor.warning.english().find("upside down") != std::string::npos;
                CHECK(is_upside_down == (sign < 0.0));
                const bool is_other = sensor.warning.english().find("BNZ is vertical by its dip") !=
                                      std::string::npos;
                CHECK(is_other == (axis != 2));
            }
}

TEST_CASE("the vertical axis is found if the sensor is turned over between the windows") {
    Mounted sensor{{0.002, -0.003, 1.0018}, kOrders[1]};
    sensor.turns_later = true;
    sensor.look();
    CHECK(sensor.epoch.channels[2].code == "BNZ");
    CHECK(sensor.warning.empty());
}

TEST_CASE("a dip that contradicts gravity is named, and gravity counts") {
    Mounted sensor{{0.0, 0.001, 1.0}, kOrders[0], {-90.0, 0.0, 0.0}};
    sensor.look();
    CHECK(sensor.epoch.channels[2].code == "BNZ");
    CHECK_THAT(sensor.warning, ContainsSubstring("BN1 is vertical by its dip"));
}

TEST_CASE("a sensor that lies askew is refused with the means of its axes") {
    Mounted sensor{{0.7, 0.1, 0.71}, kOrders[0]};
    CHECK_THROWS_WITH(sensor.look(),
                      "station.xml: no axis is vertical: BN1 0.7000 g, BN2 0.1000 "
                      "g, BNZ 0.7100 g; allowed: an axis with at least 0.9000 g "
                      "along gravity");
}
