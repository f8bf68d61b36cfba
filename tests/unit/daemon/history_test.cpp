#include <nlohmann/json.hpp>
#include "daemon/page/history_json.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/daemon/live_records.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::live;
using namespace a351::daemon::page;
using nlohmann::json;

namespace {

std::int64_t ms_of(UtcTime time) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
}

/// Adds samples without noise: x and y as given, z about 1 g, temperature 0.
void take_still(live::Record& live, std::int64_t first, std::int64_t last, std::int32_t z_counts) {
    for (std::int64_t index = first; index < last; ++index)
        live.take({index, instant_of(index), {-412, 1033, z_counts, 0}});
}

/// Returns the norm of such a sample.
double still_norm_mgal(const wire::DeviceProfile& profile, std::int32_t z_counts) {
    const auto g = [&](std::int32_t counts) { return profile.acceleration(counts).value(); };
    return kMilliGalPerStandardGravity * std::hypot(g(-412), g(1033), g(z_counts));
}

}  // namespace

TEST_CASE("a history has the smallest and largest value of each interval, with the unit") {
    live::Record live = quiet_live_record();
    take_samples(live, 0, 1000);  // 20 s.
    const auto& profile = live.profile();
    for (const auto& [name, channel] : {std::pair("x", 0), std::pair("y", 1), std::pair("z", 2)}) {
        const auto answer =
            json::parse(history_json(live, std::string("channel=") + name, minute(1)));
        CHECK(answer["channel"] == name);
        CHECK(answer["unit"] == "mg");
        CHECK(answer["interval_s"] == 2.0);
        REQUIRE(answer["points"].size() == 10);
        for (int bin = 0; bin < 10; ++bin) {
            const auto& point = answer["points"][static_cast<std::size_t>(bin)];
            CHECK(point[0] == ms_of(kMorning) + 2000 * bin);
            const auto mg = [&](int index) {
                return 1e3 * profile.acceleration(1000 * channel + index).value();
            };
            CHECK(point[1].get<double>() == Approx(mg(100 * bin)).epsilon(1e-6));
            CHECK(point[2].get<double>() == Approx(mg(100 * bin + 99)).epsilon(1e-6));
        }
    }
    const auto warm = json::parse(history_json(live, "channel=temperature", minute(1)));
    CHECK(warm["unit"] == "degC");
    const double first = profile.temperature(3000).value(),
                 last = profile.temperature(3099).value();
    CHECK(warm["points"][0][1].get<double>() == Approx(std::min(first, last)).epsilon(1e-6));
    CHECK(warm["points"][0][2].get<double>() == Approx(std::max(first, last)).epsilon(1e-6));
}

TEST_CASE("a gap in the record appears as missing points") {
    live::Record live = quiet_live_record();
    take_still(live, 0, 50 * 100, 16'650'000);
    take_still(live, 50 * 200, 50 * 300, 16'650'000);
    for (const std::string channel : {"z", "norm"}) {
        const auto points = json::parse(history_json(
            live, "channel=" + channel + "&from=2026-03-14T08:00:00Z", minute(10)))["points"];
        const auto is_in_gap = [&](const json& point) {
            return point[0].get<std::int64_t>() >= ms_of(instant_of(50 * 102)) &&
                   point[0].get<std::int64_t>() < ms_of(instant_of(50 * 198));
        };
        CHECK(points.size() > 50);
        CHECK(std::ranges::none_of(points, is_in_gap));
        if (channel != "z") continue;
        REQUIRE(points.size() == 100);
        CHECK(points[49][0] == ms_of(instant_of(50 * 98)));
        CHECK(points[50][0] == ms_of(instant_of(50 * 200)));
    }
}

TEST_CASE("a history has at most the requested number of points, within the requested times") {
    live::Record live = quiet_live_record();
    take_samples(live, 0, 50 * 120);
    const auto points = [&](const std::string& query) {
        const auto answer = json::parse(history_json(live, "channel=x" + query, minute(5)));
        return answer["points"];
    };
    CHECK(points("").size() == 60);
    CHECK(points("&points=4000").size() == 60);
    CHECK(points("&points=7").size() <= 7);
    CHECK(points("&points=1").size() == 1);
    CHECK(points("&from=2026-03-14T08:01:00Z").size() == 30);
    CHECK(points("&from=2026-03-14T08%3A00%3A10Z&to=2026-03-14T17:00:20%2B09:00").size() == 5);
    CHECK(points("&to=2026-03-14T08:00:00Z").empty());
    const auto late = json::parse(history_json(
        live, "channel=x", kMorning + std::chrono::hours(24) + std::chrono::minutes(1)));
    CHECK(late["points"].size() == 30);
}

TEST_CASE("the norm of hours is that of the three axes, to 0.001 mGal") {
    constexpr std::int64_t kStep = 50 * 200, kEnd = 50 * 400;  // 200 s at one level, then another.
    constexpr std::int32_t kBefore = 16'650'000, kAfter = 16'650'500;
    live::Record live = quiet_live_record();
    take_still(live, 0, kStep, kBefore);
    take_still(live, kStep, kEnd, kAfter);
    const double before = still_norm_mgal(live.profile(), kBefore),
                 after = still_norm_mgal(live.profile(), kAfter);
    const auto asked = [&](const std::string& query) {
        return json::parse(
            history_json(live, "channel=norm&from=2026-03-14T08:00:00Z" + query, minute(10)));
    };
    const auto all = asked("");
    CHECK(all["channel"] == "norm");
    CHECK(all["unit"] == "mGal");
    CHECK(all["interval_s"] == verdict::kLiveStepSeconds);
    REQUIRE(all["points"].size() > 100);
    for (const json& point : all["points"]) {
        // The filters mix both levels within kReachSeconds.
        const double from_step_s =
            1e-3 * static_cast<double>(point[0].get<std::int64_t>() - ms_of(instant_of(kStep)));
        if (std::abs(from_step_s) <= verdict::kReachSeconds) continue;
        CAPTURE(from_step_s);
        CHECK(point[1].get<double>() == Approx(from_step_s < 0 ? before : after).margin(0.001));
        CHECK(point[1] == point[2]);
    }
    // Joined intervals have the smallest and the largest value.
    const auto joined = asked("&points=1")["points"];
    REQUIRE(joined.size() == 1);
    CHECK(joined[0][1].get<double>() <= before + 0.001);
    CHECK(joined[0][2].get<double>() >= after - 0.001);
    const std::size_t few = asked("&points=7")["points"].size();
    CHECK(few > 1);
    CHECK(few <= 7);
}

TEST_CASE("the oven's history has process value and set point") {
    live::Record live = quiet_live_record();
    CHECK(json::parse(history_json(live, "channel=oven", minute(1)))["points"].empty());
    live.take(OvenPoint{kMorning, DegC(42.25), DegC(42.5)});
    live.take(OvenPoint{kMorning + std::chrono::seconds(3), std::nullopt, DegC(42.5)});
    live.take(OvenPoint{kMorning + std::chrono::seconds(13), DegC(42.75), DegC(43.0)});
    const auto answer = json::parse(history_json(live, "channel=oven", minute(1)));
    CHECK(answer["unit"] == "degC");
    CHECK(answer["interval_s"] == 3.0);
    const auto begin = ms_of(kMorning);
    CHECK(answer["points"] == json::array({json::array({begin, 42.25, 42.5}),
                                           json::array({begin + 3000, nullptr, 42.5}),
                                           json::array({begin + 13000, 42.75, 43.0})}));
}

TEST_CASE("a wrong history query is refused with an error that names the key") {
    live::Record live = quiet_live_record();
    const auto trouble = [&](const std::string& query) {
        try {
            (void)history_json(live, query, minute(1));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    CHECK(trouble("channel=x") == "none");
    const auto of_centuries = json::parse(
        history_json(live, "channel=norm&points=1&from=1700-01-01T00:00:00Z", minute(1)));
    CHECK(of_centuries["interval_s"].get<double>() > 0.0);
    for (const auto& [query, part] :
         {std::pair("", "channel"), std::pair("channel=w", "channel = w"),
          std::pair("channel=x&points=0", "points = 0; allowed: 1 to 4000"),
          std::pair("channel=x&points=4001", "points"), std::pair("channel=x&points=-1", "points"),
          std::pair("channel=x&points=1e3", "points"), std::pair("channel=x&points=", "points"),
          std::pair("channel=x&points=99999999999999999999", "points"),
          std::pair("channel=x&from=noon", "from = noon"), std::pair("channel=x&to=", "to = "),
          std::pair("channel=x&from=2026-03-14T09:00:00Z&to=2026-03-14T09:00:00Z", "from"),
          std::pair("channel=x&channel=y", "twice"), std::pair("channel=x&rate=1", "rate"),
          std::pair("channel=%zz", "encoding"), std::pair("channel=%4", "encoding"),
          std::pair("channel", "channel"), std::pair("&channel=x", "key ")}) {
        CAPTURE(query, trouble(query));
        CHECK(trouble(query).find(part) != std::string::npos);
        CHECK(trouble(query).find('\n') == std::string::npos);
    }
}
