#include "daemon/live/live_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>
#include "protocol/signal/decimation.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/live/live_samples.hpp"

using namespace a351::daemon::verdict;

namespace a351::daemon::live {
namespace {

verdict::RunningReading reading_between(const Record& record, UtcTime from, UtcTime to) {
    const events::Occupation::SetUp set_up{from, to};
    return record.reading({&set_up, 1});
}

/// Gives the record the samples [from, to) of one acceleration, mGal.
void play(Record& record, std::int64_t from, std::int64_t to, double x = 0.0, double y = 0.0,
          double z = 980000.0) {
    for (std::int64_t i = from; i < to; ++i) record.take(placed(i, x, y, z));
}

double wave(std::int64_t i) { return 500.0 * std::sin(0.01 * static_cast<double>(i)); }

TEST_CASE("until the filters are full the verdict is no data, since the first sample") {
    Record record(kProfile, 50, {});
    play(record, 0, 500);
    const Verdict verdict = record.verdict();
    CHECK(verdict.state == verdict::State::no_data);
    CHECK(verdict.since == kZero);
}

TEST_CASE("troubles of the sensor are those of this run, not of the history") {
    Record record(kProfile, 50, {});
    const auto play = [&](std::int64_t from) {
        for (std::int64_t i = from; i < from + 500; ++i)
            record.take(placed(i, wave(i), wave(i), 490000.0 + wave(i)));
        return record.troubles().size();
    };
    CHECK(play(0) == 1);
    record.end_of_history();
    CHECK(record.troubles().empty());
    CHECK(play(500) == 1);
}

TEST_CASE("the vertical axis is compared with the history, but not that of another sensor") {
    for (const bool is_other : {false, true}) {
        Record record(kProfile, 50, {});
        const auto play = [&](std::int64_t from, double x, double z) {
            for (std::int64_t i = from; i < from + 5000; ++i)
                record.take(placed(i, x + wave(i), wave(i), z + wave(i)));
        };
        play(0, 0.0, 980000.0);
        record.end_of_history();
        if (is_other) record.begin_unit(placed(4999, 0.0, 0.0, 0.0).time);
        play(5000, 980000.0, 0.0);
        CHECK(record.troubles().size() == (is_other ? 0 : 1));
    }
}

TEST_CASE("the oven inside, not the outer one, is compared with the sensor") {
    for (const auto place : {journal::OvenPlace::inner, journal::OvenPlace::outer}) {
        Record record(kProfile, 50, {});  // The sensor has 42.5 degC.
        for (std::int64_t i = 0; i < 50 * 650; ++i) {
            const PlacedSample sample = placed(i, 0.0, 0.0, 980000.0);
            if (i % 50 == 0) record.take(OvenPoint{sample.time, DegC(60.0), DegC(60.0), place});
            record.take(sample);
        }
        const auto troubles = record.troubles();
        CHECK(std::ranges::count_if(troubles, [](const text::Message& trouble) {
                  return trouble.english().find("follow the oven") != std::string::npos;
              }) == (place == journal::OvenPlace::inner ? 1 : 0));
    }
}

TEST_CASE("a viewer reads every sample once, in blocks without a gap") {
    Record record(kProfile, 50, {});
    for (std::int64_t i = 0; i < 1000; ++i)
        if (i < 400 || i >= 410) record.take(placed(i, static_cast<double>(i), 0.0, 980000.0));
    std::uint64_t cursor = 0;
    std::int64_t expected = 0;
    while (const auto block = record.block_from(cursor, 150)) {
        if (expected == 400) expected = 410;
        CHECK(block->first_index == expected);
        CHECK(block->first_time == placed(expected, 0, 0, 0).time);
        REQUIRE(block->counts[0].size() <= 150);
        for (std::size_t k = 0; k < block->counts[0].size(); ++k)
            CHECK(block->counts[0][k] ==
                  counts_of(static_cast<double>(expected) + static_cast<double>(k)));
        expected += static_cast<std::int64_t>(block->counts[0].size());
    }
    CHECK(expected == 1000);
    CHECK(cursor == record.end());
    CHECK(record.end() == 990);
}

TEST_CASE("a viewer that returns late continues with the oldest sample that is kept") {
    Record record(kProfile, 50, {});
    play(record, 0, 20000);
    std::uint64_t cursor = 17;
    const auto block = record.block_from(cursor, 100000);
    REQUIRE(block);
    CHECK(block->first_index == 20000 - 12500);  // The least number of samples that is kept.
    CHECK(cursor == 20000);
}

TEST_CASE(
    "samples that a replay delivers again are skipped, although the archive rounds their times") {
    Record record(kProfile, 50, {});
    play(record, 0, 100);
    record.end_of_history();
    for (std::int64_t i = 50; i < 120; ++i) {
        PlacedSample again = placed(i, 0.0, 0.0, 980000.0);
        again.time += std::chrono::microseconds(1);
        record.take(again);
    }
    CHECK(record.end() == 120);
}

/// Returns a sample with varying temperature and acceleration, as the verdict requires.
PlacedSample steady(std::int64_t i) {
    PlacedSample sample = placed(i, 0.0, 0.0, 980000.0);
    sample.counts[3] += static_cast<std::int32_t>(i % 7) - 3;
    sample.counts[2] += static_cast<std::int32_t>(i % 5) - 2;
    return sample;
}

TEST_CASE("a clock that is set back starts the history again from there") {
    constexpr std::int64_t kBefore = 40 * 60 * 50, kBehind = 60 * 50;
    constexpr Nanoseconds kBack = std::chrono::minutes(30);
    Record record(kProfile, 50, {});
    for (std::int64_t i = 0; i < kBefore; ++i) {
        PlacedSample sample = steady(i);
        if (i > kBefore - 5000 && i % 20 == 0) sample.counts[0] = counts_of(5000.0);  // Knocks.
        record.take(sample);
    }
    CHECK(record.verdict().state == verdict::State::disturbed);
    for (std::int64_t i = kBefore; i < kBefore + kBehind; ++i) {
        PlacedSample sample = steady(i);
        sample.time -= kBack;
        record.take(sample);
    }
    CHECK(record.end() == kBefore + kBehind);
    CHECK(record.verdict().state == verdict::State::settling);
    CHECK(record.history(Channel::x, after(600.0), after(4000.0), 4000).size() == 30);
    const auto reading = reading_between(record, after(600.0), after(4000.0));
    CHECK(reading.used_s == Approx(60.0 - 20.0).margin(4.0));
}

TEST_CASE("the states of the past end at a gap of 90 s, and equal thresholds change none") {
    Record record(kProfile, 50, {});
    const auto take = [&](std::int64_t first, std::int64_t end) {
        for (std::int64_t i = first; i < end; ++i) record.take(steady(i));
    };
    take(0, 1800 * 50);
    CHECK(record.state_at(after(5.0)) == verdict::State::no_data);
    CHECK(record.state_at(after(600.0)) == verdict::State::settling);
    record.judge_by({});
    take(1800 * 50, 1810 * 50);
    CHECK(record.state_at(after(1809.0)) == verdict::State::stable);
    take(1900 * 50, 1900 * 50 + 1);
    CHECK(record.verdict().state == verdict::State::no_data);
    // The last value of the series is older than the last sample by the reach of its filters, 9 s.
    const double gap_s = verdict::Options{}.gap_s;
    CHECK(record.state_at(after(1810.0 + gap_s - 10.0)) == verdict::State::stable);
    CHECK(record.state_at(after(1810.0 + gap_s)) == verdict::State::no_data);
}

TEST_CASE("the live series is identical to the decimation in the evening's correction") {
    Thinning thinning(kProfile, 50);
    std::vector<LiveSample> live;
    std::vector<double> z;
    for (std::int64_t i = 0; i < 6000; ++i) {
        const PlacedSample sample = placed(i, 0.0, wave(i), 980000.0 + wave(i));
        z.push_back(to_milligal(kProfile.acceleration(sample.counts[2])).value());
        thinning.take(sample, live);
    }
    const auto filter = signal::design_decimation(10);
    const auto evening = signal::decimate(signal::decimate(z, filter), filter);
    REQUIRE(live.size() == 56);
    int finite = 0;
    for (std::size_t k = 0; k < live.size(); ++k) {
        CHECK(live[k].time == after(2.0 * static_cast<double>(k)));
        CHECK(seconds_between(live[k].time, live[k].seen_at) == Approx(9.98));
        if (std::isnan(evening[k])) {
            CHECK(std::isnan(live[k].axes[2].value()));
        } else {
            CHECK(live[k].axes[2].value() == evening[k]);
            CHECK(live[k].temperature.value() ==
                  Approx(kProfile.temperature(-1981).value()).epsilon(1e-12));
            ++finite;
        }
    }
    CHECK(finite == 51);
    // From 28 to 30 s the wave falls.
    CHECK(live[10].shake.value() == Approx(0.5 * (wave(1414) - wave(1499))).margin(0.1));
}

TEST_CASE("all rates of the profile are decimated to 2 s with filters of the same length in time") {
    for (const auto& rate : kProfile.output_rates_hz) {
        Thinning thinning(kProfile, rate.value);
        std::vector<LiveSample> live;
        for (std::int64_t i = 0; i < 60 * rate.value; ++i) {
            PlacedSample sample = placed(0, 0.0, 0.0, 980000.0);
            sample.time = after(static_cast<double>(i) / rate.value);
            thinning.take(sample, live);
        }
        CAPTURE(rate.value);
        REQUIRE(live.size() == 26);
        CHECK(std::isnan(live[4].axes[2].value()));
        CHECK(live[5].axes[2].value() == Approx(980000.0).epsilon(0.0).margin(0.1));
        CHECK(seconds_between(live[7].time, live[8].time) == Approx(2.0));
    }
}

TEST_CASE(
    "a missing sample affects only the values whose filter includes it, a long gap restarts the "
    "filter") {
    Thinning thinning(kProfile, 50);
    std::vector<LiveSample> live;
    for (std::int64_t i = 0; i < 6000; ++i)
        if (i != 3000) thinning.take(placed(i, 0.0, 0.0, 980000.0), live);
    REQUIRE(live.size() == 56);
    int missing = 0;
    for (std::size_t k = 5; k < live.size(); ++k) missing += std::isnan(live[k].axes[2].value());
    CHECK(missing == 9);  // 60 s +- 9 s
    live.clear();
    for (std::int64_t i = 12000; i < 13000; ++i) thinning.take(placed(i, 0.0, 0.0, 980000.0), live);
    REQUIRE(live.size() == 6);
    CHECK(live[0].time == after(240.0));
    CHECK(std::isnan(live[4].axes[2].value()));
    CHECK_FALSE(std::isnan(live[5].axes[2].value()));
}

TEST_CASE("the live record gives its samples to the verdict and to the reading") {
    Record record(kProfile, 50, {});
    CHECK(record.verdict().state == verdict::State::no_data);
    for (std::int64_t i = 0; i < 40 * 60 * 50; ++i) record.take(steady(i));
    CHECK(record.verdict().state == verdict::State::stable);
    const auto reading = reading_between(record, after(1200.0), after(2380.0));
    REQUIRE(reading.value);
    CHECK(reading.value->value() == Approx(980000.0).epsilon(0.0).margin(0.06));
    CHECK(reading.used_s == Approx(1162.0).margin(2.0));

    verdict::Options strict;
    strict.history_min = 120.0;
    record.judge_by(strict);
    CHECK(record.verdict().state == verdict::State::settling);
    record.judge_by({});
    CHECK(record.verdict().state == verdict::State::stable);
}

using Changes = std::vector<std::string>;

/// Gives the record the seconds [from, to) of a box at rest that is knocked from 1500 to 1502 s, and
/// returns the changes of the verdict: state and time in s.
/// @param early  samples whose times are not known well yet: they come out 1.94 s late
Changes changes_of(Record& record, int from, int to, int early = 0) {
    const auto last = record.last_sample();
    const auto first = last ? std::llround(50.0 * seconds_between(kZero, *last)) : 0;
    for (std::int64_t i = 50 * from; i < 50 * to; ++i) {
        PlacedSample sample = steady(i);
        if (i < early) sample.time += std::chrono::milliseconds(1940);
        if (i >= 50 * 1500 && i < 50 * 1502 && i % 20 == 0) sample.counts[0] = counts_of(5000.0);
        record.take(sample);
    }
    Changes changes;
    std::optional<verdict::State> before;
    if (last) before = record.state_at(*last);
    for (std::int64_t i = first; i < 50 * to; ++i) {
        const double at_s = 0.02 * static_cast<double>(i);
        const auto state = record.state_at(after(at_s));
        if (state == before) continue;
        changes.push_back(fmt::format("{} {:.2f}", to_text(state), at_s));
        before = state;
    }
    return changes;
}

TEST_CASE("each change of the verdict has the time of the data that show it") {
    Record record(kProfile, 50, {});
    CHECK(changes_of(record, 0, 1800) == Changes{"no data 0.00", "settling 19.98", "stable 1229.98",
                                                 "disturbed 1501.98", "stable 1573.98"});
    // The lack is known when the data return and have filled the filters.
    CHECK(changes_of(record, 1900, 2000) == Changes{"no data 1809.98", "stable 1919.98"});
}

TEST_CASE("sample times that are corrected in the first minute do not move later verdicts") {
    Record record(kProfile, 50, {});
    changes_of(record, 0, 100, 2037);
    CHECK(changes_of(record, 100, 1800) ==
          Changes{"stable 1229.98", "disturbed 1501.98", "stable 1573.98"});
}

TEST_CASE("another sensor is judged afresh, and its reading has no data of the one before") {
    Record record(kProfile, 50, {});
    constexpr std::int64_t kExchange = 50 * 1800, kNext = kExchange + 50 * 5,
                           kEnd = kNext + 50 * 300;
    for (std::int64_t i = 0; i < kExchange; ++i) record.take(steady(i));
    REQUIRE(record.verdict().state == verdict::State::stable);
    const UtcTime last = placed(kExchange - 1, 0.0, 0.0, 0.0).time;
    SECTION("while it records") {
        record.begin_unit(last);
        CHECK(record.verdict().state == verdict::State::no_data);
        play(record, kNext, kEnd, 0.0, 0.0, 979000.0);
    }
    SECTION("after a restart, when the archive gives the data of both") {
        play(record, kNext, kEnd, 0.0, 0.0, 979000.0);
        record.end_of_history();
        record.begin_unit(last);
    }
    Record fresh(kProfile, 50, {});
    play(fresh, kNext, kEnd, 0.0, 0.0, 979000.0);
    CHECK(record.verdict().state == fresh.verdict().state);
    CHECK(record.motion(kZero, last).empty());
    const auto reading = reading_between(record, kZero, placed(kEnd, 0.0, 0.0, 0.0).time);
    REQUIRE(reading.value);
    CHECK(std::abs(reading.value->value() - 979000.0) < 0.5);
    CHECK_FALSE(record.level_against(kZero, last));
    CHECK_FALSE(record.history(Channel::z, kZero, last, 100).empty());
}

TEST_CASE("tilt is given relative to a set-up, with the side to turn") {
    const auto mgal_of = [](double arcmin) {
        return kMilliGalPerStandardGravity * std::sin(arcmin / 60.0 * std::numbers::pi / 180.0);
    };
    Record record(kProfile, 50, {});
    play(record, 0, 6000, mgal_of(30.0), mgal_of(-20.0), 980000.0);
    play(record, 6000, 6200, mgal_of(32.4), mgal_of(-20.9), 980000.0);
    const auto level = record.level_against(kZero, after(120.0));
    REQUIRE(level);
    CHECK(level->tilt_arcmin[0] == Approx(2.4).margin(0.001));
    CHECK(level->tilt_arcmin[1] == Approx(-0.9).margin(0.001));
    CHECK_FALSE(level->is_within);
    CHECK(level->advice == std::vector<text::Message>{"lower the +x side by 2.4'"});
    play(record, 6200, 6400, mgal_of(30.5), mgal_of(-20.9), 980000.0);
    CHECK(record.level_against(kZero, after(120.0))->is_within);
    CHECK_FALSE(record.level_against(after(500.0), after(600.0)));
}

TEST_CASE("the level of a sensor on its side is that of its horizontal axes") {
    constexpr double kArcmin_mgal = 285.26;  // g sin 1'
    Record record(kProfile, 50, {});
    play(record, 0, 6000, -980000.0, 5.0 * kArcmin_mgal, 2.0 * kArcmin_mgal);
    play(record, 6000, 6200, -980000.0, 5.5 * kArcmin_mgal, 0.0);
    const auto level = record.level_against(kZero, after(120.0));
    REQUIRE(level);
    CHECK(level->axes == std::array{'y', 'z'});
    CHECK(level->tilt_arcmin[0] == Approx(0.5).margin(0.001));
    CHECK(level->advice == std::vector<text::Message>{"raise the +z side by 2.0'"});
}

TEST_CASE("lifting the box at the end of a set-up does not change the level of that set-up") {
    constexpr double kLevel = 8000.0, kLifted = 80'000.0;  // 28' and 4.7 deg.
    Record record(kProfile, 50, {});
    for (std::int64_t i = 0; i < 600 * 50; ++i)
        record.take(placed(i, i < 540 * 50 ? kLevel : kLifted, 0.0, 980000.0));
    play(record, 600 * 50, 630 * 50, kLevel, 0.0, 980000.0);
    const auto level = record.level_against(kZero, after(600.0));
    REQUIRE(level);
    CHECK(level->tilt_arcmin[0] == Approx(0.0).margin(0.01));
    CHECK(level->is_within);
}

TEST_CASE("nothing from before or after a set-up enters its reading") {
    Record record(kProfile, 50, {});
    for (std::int64_t i = 0; i < 600 * 50; ++i) {
        const bool is_within = i >= 100 * 50 && i < 400 * 50;
        record.take(placed(i, 0.0, 0.0, is_within ? 980000.0 : 979000.0));
    }
    const auto reading = reading_between(record, after(100.0), after(400.0));
    REQUIRE(reading.value);
    CHECK(reading.value->value() == Approx(980000.0).epsilon(0.0).margin(0.1));
    CHECK(reading.used_s == Approx(300.0 - 18.0).margin(2.0));
}

TEST_CASE("oven values are kept for a day, at most one every 2 s") {
    Record record(kProfile, 50, {});
    for (int i = 0; i < 100; ++i) record.take(OvenPoint{after(i), DegC(42.0 + i), DegC(42.5)});
    CHECK(record.oven_history(journal::OvenPlace::inner, kZero, after(1000.0), 1000).size() == 50);
    const auto few = record.oven_history(journal::OvenPlace::inner, kZero, after(1000.0), 7);
    REQUIRE(few.size() == 7);
    CHECK(few[0].process_value == DegC(42.0));
    CHECK(few[1].time == after(16.0));
    record.take(OvenPoint{after(3.0), DegC(38.0), DegC(38.5), journal::OvenPlace::outer});
    const auto outer = record.oven_history(journal::OvenPlace::outer, kZero, after(1000.0), 1000);
    REQUIRE(outer.size() == 1);
    CHECK(outer[0].process_value == DegC(38.0));
    CHECK(record.oven_history(journal::OvenPlace::inner, kZero, after(1000.0), 1000).size() == 50);
    journal::OvenChunk lost;
    lost.outcome = journal::OvenOutcome::timed_out;
    CHECK_FALSE(oven_point(lost, kZero));
}

}  // namespace
}  // namespace a351::daemon::live
