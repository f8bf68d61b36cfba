#include "sim/survey/direct_survey.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "protocol/core/input_error.hpp"
#include "protocol/record/archive_reader.hpp"
#include "protocol/record/event_log.hpp"
#include "protocol/record/station_xml.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/truth/truth_file.hpp"

using namespace a351;
using namespace a351::sim;

TEST_CASE("a day written to a data root reads back as the truth", "[sim][direct_survey]") {
    const auto root =
        std::filesystem::temp_directory_path() / ("a351_direct_" + std::to_string(::getpid()));
    const Scenario scenario = parse_scenario(
        "base = \"tsukuba\"\nname = \"short\"\n[schedule]\nlead_in_h = 0.2\nlead_out_min = 8\n"
        "[[occupation]]\nsite = \"No.0\"\ncentre_utc = \"2017-07-16T23:55:00Z\"\nambient_degc = "
        "25\n",
        "short.toml");
    const DirectSurvey written = write_survey(scenario, *wire::find_profile("A351"), 1, root);
    const auto truth = read_truth(root / "truth.bin");
    REQUIRE(written.frames == static_cast<std::int64_t>(truth.size()));
    REQUIRE(truth.size() > 50 * 60 * 15);

    const auto channel = record::read_channel(root / "archive", {}, "BNZ", scenario.start(),
                                              scenario.end() + std::chrono::hours(1));
    REQUIRE(channel.segments.size() == 1);
    REQUIRE(channel.segments[0].counts.size() == truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
        REQUIRE(channel.segments[0].counts[i] == truth[i].values.axes[2]);
        // Arrivals carry no delay but the device's own, of which the archive need not know the
        // internal 0.43 ms.
        REQUIRE(std::abs(seconds_between(truth[i].utc, channel.segments[0].time_of(i))) < 1e-4);
    }

    const auto occupations = record::occupations_of(record::read_events(root / "events").events);
    const auto plan = plan_survey(scenario, 1);
    REQUIRE(occupations.size() == 1);
    CHECK(occupations[0].site == "No.0");
    REQUIRE(occupations[0].set_ups.size() == 1);
    CHECK(std::abs(seconds_between(plan[0].start, occupations[0].set_ups[0].start)) <= 0.02);
    CHECK(std::abs(seconds_between(plan[0].end, occupations[0].set_ups[0].end)) <= 0.02);
    CHECK(record::read_station_xml(root / "metadata" / "station.xml").channels.size() >= 4);
    CHECK(std::filesystem::exists(root / "survey.toml"));

    CHECK_THROWS_AS(write_survey(scenario, *wire::find_profile("A351"), 1, root), InputError);
    std::filesystem::remove_all(root);
}
