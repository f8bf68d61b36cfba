#include "sim/survey/direct_survey.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <set>
#include "tests/support/catch.hpp"

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/wire/shipped_profiles.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/sim/made_up_scenario.hpp"
#include "tests/unit/sim/truth_reader.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::scenario;
using namespace a351::sim::survey;
using namespace a351::sim::truth;

namespace {

/// A day, written to a temporary data root.
struct Written {
    explicit Written(const Scenario& scenario, const char* profile = "A351", std::uint64_t seed = 1)
        : day(write_survey(scenario, *wire::find_profile(profile), seed, directory.path())) {}

    [[nodiscard]] std::filesystem::path file(const char* name) const {
        return directory.path() / name;
    }
    [[nodiscard]] journal::Header header() const {
        journal::Reader reader(journal::segment_files(file("journal")).front());
        return std::get<journal::Header>(*reader.next());
    }

    test::TemporaryDirectory directory;
    DirectSurvey day;
};

/// Returns a scenario with two stations within half an hour.
Scenario brief_day(const std::string& name = "brief", const std::string& more = "",
                   const std::string& date = "2017-07-16") {
    const std::string text = "base = \"ideal\"\nname = \"" + name +
                             "\"\n[schedule]\nlead_in_h = 0.2\nlead_out_min = 8\n"
                             "length_s = 300\nshortest_s = 300\njitter_s = 20\n" +
                             stay("No.0", "01:00:00", "", date) +
                             stay("No.1", "01:10:00", "", date) + more;
    return parse_scenario(text, "brief.toml");
}

}  // namespace

TEST_CASE("a day written to a data root reads back as the truth") {
    const Scenario scenario =
        changed("tsukuba", "[schedule]\nlead_in_h = 0.2\nlead_out_min = 10\nsetups = 2\n" +
                               stay("No.0", "23:55:00"));
    const Written written(scenario);
    const auto truth = read_truth(written.file("truth.bin"));
    REQUIRE(written.day.frames == static_cast<std::int64_t>(truth.size()));
    REQUIRE(truth.size() > 50 * 60 * 15);

    const auto channel = archive::read_channel(written.file("archive"), {}, "BNZ", scenario.start(),
                                               scenario.end() + std::chrono::hours(1));
    REQUIRE(channel.segments.size() == 1);
    REQUIRE(channel.segments[0].counts.size() == truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
        REQUIRE(channel.segments[0].counts[i] == truth[i].values.axes[2]);
        // Arrivals have only the device's own delay.  The archive need not know its internal part,
        // 0.43 ms.
        REQUIRE(std::abs(seconds_between(truth[i].utc, channel.segments[0].time_of(i))) < 1e-4);
    }

    const auto occupations =
        events::occupations_of(events::read_events(written.file("events")).events);
    const auto plan = plan_survey(scenario, 1);
    REQUIRE(plan.size() == 2);
    REQUIRE(occupations.size() == 1);
    CHECK(occupations[0].site == "No.0");
    REQUIRE(occupations[0].set_ups.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(std::abs(seconds_between(plan[i].start, occupations[0].set_ups[i].start)) <= 0.02);
        CHECK(std::abs(seconds_between(plan[i].end, occupations[0].set_ups[i].end)) <= 0.02);
    }
    CHECK(text::read_csv(written.file("schedule.csv")).row_count() == 2);
    CHECK(text::read_csv(written.file("truth.csv")).row_count() == 2);
    CHECK(station::read_station_xml(written.file("metadata") / "station.xml").channels.size() >= 4);
    CHECK_FALSE(std::filesystem::exists(written.file("survey.toml")));  // One site: no survey.
    CHECK_FALSE(std::filesystem::exists(written.file("partial")));
}

TEST_CASE("a day is not written to a directory that has any part of another") {
    const test::TemporaryDirectory directory;
    for (const char* name : {"journal", "archive", "events", "metadata", "truth.bin", "sites.csv",
                             "schedule.csv", "truth.csv", "survey.toml", "partial"}) {
        std::filesystem::create_directories(directory.path() / name);
        CAPTURE(name);
        CHECK_THROWS_WITH(
            write_survey(brief_day(), *wire::find_profile("A351"), 1, directory.path()),
            ContainsSubstring(std::string("already holds ") + name) && !ContainsSubstring("\n"));
        std::filesystem::remove_all(directory.path() / name);
    }
    CHECK(std::filesystem::is_empty(directory.path()));
    // An empty directory is accepted.
    static_cast<void>(write_survey(brief_day(), *wire::find_profile("A351"), 1, directory.path()));
    CHECK(std::filesystem::exists(directory.path() / "journal"));
    CHECK(std::filesystem::exists(directory.path() / "survey.toml"));
}

TEST_CASE("a day that cannot be written completely leaves no files") {
    const test::TemporaryDirectory directory;
    rlimit limit{};
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &limit) == 0);
    const rlimit small{1'000'000, limit.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
    bool has_failed = false;
    try {
        static_cast<void>(
            write_survey(brief_day(), *wire::find_profile("A351"), 1, directory.path()));
    } catch (const std::system_error&) {
        has_failed = true;
    }
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, handler);
    CHECK(has_failed);
    CHECK(std::filesystem::is_empty(directory.path()));
}

TEST_CASE("a day has the filter of the profile by its code, and is refused without it") {
    const test::TemporaryDirectory directory;
    const auto shipped =
        std::ranges::find(wire::shipped_profiles(), "A351", &wire::ShippedProfile::name);
    const auto written = [&](const std::string& filter) {
        std::string toml(shipped->toml);
        const std::string_view own = "\"k512_fc9\", code = 6";
        toml.replace(toml.find(own), own.size(), filter);
        const auto root = directory.path() / "day";
        std::filesystem::create_directories(root);
        std::ofstream(directory.path() / "mine.toml") << toml;
        static_cast<void>(
            write_survey(brief_day(), wire::load_profile(directory.path() / "mine.toml"), 1, root));
        journal::Reader reader(journal::segment_files(root / "journal").front());
        return std::get<journal::Header>(*reader.next()).filter;
    };
    CHECK(written("\"of_mine\", code = 6") == "of_mine");
    std::filesystem::remove_all(directory.path() / "day");
    CHECK_THROWS_AS(written("\"of_mine\", code = 15"), InputError);
}

TEST_CASE("the session id of a day depends on its scenario, start, profile and seed") {
    const std::array headers{Written(brief_day()).header(), Written(brief_day("another")).header(),
                             Written(brief_day("brief", "", "2017-07-17")).header(),
                             Written(brief_day(), "A352AD10").header(),
                             Written(brief_day(), "A351", 2).header()};
    for (std::size_t i = 0; i < headers.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            CAPTURE(i, j);
            CHECK(headers[i].session != headers[j].session);
            CHECK(headers[i].boot_id != headers[j].boot_id);
        }
    }
    CHECK(Written(brief_day()).header().session == headers.front().session);
}

TEST_CASE("events and tables are in true time, even if the clock of the sensor is wrong") {
    const Scenario scenario = brief_day("brief", "[clock]\nerror_ppm = 100\n");
    const Written written(scenario);
    const auto truth = read_truth(written.file("truth.bin"));
    const auto events = events::read_events(written.file("events")).events;
    const auto schedule = text::read_csv(written.file("schedule.csv"));
    const auto rows = text::read_csv(written.file("truth.csv"));
    const auto plan = plan_survey(scenario, 1);
    REQUIRE(events.size() == 2 * plan.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        const char* column = i % 2 == 0 ? "start_utc" : "end_utc";
        const UtcTime listed = *parse_rfc3339(schedule.cell(i / 2, column));
        const UtcTime counted = i % 2 == 0 ? plan[i / 2].start : plan[i / 2].end;
        CAPTURE(i);
        REQUIRE(events[i].index);
        const truth::Record& frame = truth.at(static_cast<std::size_t>(*events[i].index));
        CHECK(std::abs(seconds_between(frame.utc, events[i].utc)) < 0.01);
        CHECK(seconds_between(listed, events[i].utc) > -0.001);
        CHECK(seconds_between(listed, events[i].utc) < 0.021);
        CHECK(rows.cell(i / 2, column) == schedule.cell(i / 2, column));
        // The sensor's clock is fast: its seconds are shorter.
        CHECK(seconds_between(listed, counted) ==
              Approx(1e-4 * seconds_between(scenario.start(), listed)).margin(0.001));
    }
    CHECK(1e-4 * seconds_between(scenario.start(), scenario.end()) > 0.1);
}

TEST_CASE("a day with two ovens has the channels of both, and a term of its truth") {
    const std::string outer =
        "[outer_oven]\nheater_capacity_j_per_k = 1500\nbody_capacity_j_per_k = 400\n"
        "heater_body_k_per_w = 1\nheater_ambient_k_per_w = 3\nbody_ambient_k_per_w = 20\n"
        "self_heating_w = 0\nheater_power_w = 15\nthermocouple_tau_s = 120\ndead_time_s = 60\n"
        "set_point_degc = 38\nresolution_degc = 0.1\nproportional_per_degc = 0\n"
        "integral_per_degc_s = 0\ncontroller = \"onoff\"\nrun_in_h = 2\n"
        "reading_mgal_per_degc = 10\nreading_tau_s = 600\n";
    const Scenario day = brief_day("two-ovens", outer);
    const Written written(day);
    const auto metadata = station::read_station_xml(written.file("metadata") / "station.xml");
    for (const char* code : {"LK2", "LK3", "LYH", "LK4", "LK5", "LYO"}) {
        CAPTURE(code);
        CHECK(std::ranges::count(metadata.channels, code, &station::ChannelScale::code) == 1);
        const auto data = archive::read_channel(written.file("archive"), metadata.codes, code,
                                                day.start(), day.end());
        std::size_t samples = 0;
        for (const auto& segment : data.segments) {
            samples += segment.counts.size();
            for (const std::int32_t counts : segment.counts) {
                if (code == std::string("LK2")) REQUIRE(std::abs(counts - 42'500) <= 200);
                if (code == std::string("LK4")) REQUIRE(std::abs(counts - 38'000) <= 1'500);
            }
        }
        CHECK(static_cast<double>(samples) > seconds_between(day.start(), day.end()) - 5.0);
    }
    CHECK(text::read_csv(written.file("truth.csv")).has_column("outer_oven_mgal"));
}

TEST_CASE("a record at one point has an archive, one site and no survey") {
    const Scenario scenario =
        changed("indoor", "[schedule]\nduration_h = 0.1\n[clock]\nerror_ppm = 100\n");
    const Written written(scenario);
    const auto truth = read_truth(written.file("truth.bin"));
    CHECK(written.day.frames == static_cast<std::int64_t>(truth.size()));
    CHECK(written.day.frames > 50 * 359);  // The first samples pass before the filter has settled.
    CHECK(text::read_csv(written.file("sites.csv")).row_count() == 1);
    CHECK(text::read_csv(written.file("schedule.csv")).row_count() == 0);
    CHECK(text::read_csv(written.file("truth.csv")).row_count() == 0);
    CHECK_FALSE(std::filesystem::exists(written.file("survey.toml")));
    // The archive's times follow the sensor's own clock, here 100 ppm fast.
    CHECK(seconds_between(scenario.start(), truth.back().utc) ==
          Approx(359.98 * (1.0 - 1e-4)).margin(1e-4));
    const auto channel = archive::read_channel(written.file("archive"), {}, "BNZ", scenario.start(),
                                               scenario.end() + std::chrono::hours(1));
    REQUIRE(channel.segments.size() == 1);
    REQUIRE(channel.segments[0].counts.size() == truth.size());
    CHECK(std::abs(seconds_between(truth.back().utc,
                                   channel.segments[0].time_of(truth.size() - 1))) < 1e-3);
}

TEST_CASE("a step and gross placements are planned as the scenario asks") {
    const Scenario tsukuba =
        changed("tsukuba",
                "[slow_noise]\ntransport_step_mgal = 8\n"
                "placement_gross_share = 0.25\nplacement_gross_factor = 100\n");
    int gross = 0;
    std::set<std::size_t> places;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const auto plan = plan_survey(tsukuba, seed);
        std::size_t place = 0;
        for (std::size_t i = 0; i < plan.size(); ++i) {
            if (i > 0) CHECK(plan[i].step_mgal >= plan[i - 1].step_mgal);
            if (plan[i].step_mgal == 0.0) place = i + 1;
            if (std::abs(plan[i].placement_mgal) > 6.0) ++gross;  // five deviations
        }
        CHECK(plan.front().step_mgal == 0.0);
        CHECK(plan.back().step_mgal == 8.0);
        places.insert(place);
    }
    CHECK(places.size() > 10);  // of 18 drives
    CHECK(gross / (40.0 * 19.0) == Approx(0.25).margin(0.05));
}
