#include "corrector/job/survey_amendments.hpp"

#include "tests/support/catch.hpp"

#include "corrector/job/survey_readings.hpp"
#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::corrector;
using job::with_amendments_key;

TEST_CASE("the key amendments is replaced, or put behind [survey]; nothing else changes") {
    CHECK(with_amendments_key("# day\n[survey]\nname = \"d\"\n", "a.toml") ==
          "# day\n[survey]\namendments = \"a.toml\"\nname = \"d\"\n");
    CHECK(with_amendments_key("[survey]\nname = 'd'\n amendments = \"old#1.toml\" # why\n[prior]\n",
                              "new.toml") ==
          "[survey]\nname = 'd'\namendments = \"new.toml\"\n[prior]\n");
    CHECK(with_amendments_key("[ survey ]", "a \"b\".toml") ==
          "[ survey ]\namendments = \"a \\\"b\\\".toml\"\n");
    CHECK(with_amendments_key("[survey]\n# amendments = \"\"\n", "a.toml") ==
          "[survey]\namendments = \"a.toml\"\n# amendments = \"\"\n");
    CHECK_THROWS_AS(with_amendments_key("survey.root = \".\"\n", "a.toml"), InputError);
    // A long line is no trouble.
    const std::string padding = "#" + std::string(1'000'000, 'x') + '\n';
    CHECK(with_amendments_key(padding + "[survey]\n", "a").starts_with(padding));
}

TEST_CASE("steps that do not divide the readings are not used, with a warning") {
    reading::OccupationRows read;
    const UtcTime start = parse_rfc3339("2026-05-01T00:00:00Z").value();
    const auto hour = [start](double h) { return start + from_seconds(3600.0 * h); };
    for (const double h : {1.0, 2.0, 3.0}) {
        read.rows.emplace_back();
        read.rows.back().site = "A";
        read.rows.back().time = hour(h);
    }
    read.rows.emplace_back();
    read.rows.back().time = hour(4.0);
    read.rows.back().is_excluded = true;
    read.amendments.steps = {hour(0.5), hour(1.5), hour(1.6), hour(2.5), hour(3.5)};
    const auto options = job::with_sites_of(read, {});
    REQUIRE(options.steps.size() == 2);
    CHECK(options.steps[0].time == hour(1.5));
    CHECK(options.steps[1].time == hour(2.5));
    REQUIRE(read.warnings.size() == 3);
    CHECK(read.warnings[0] ==
          "the step at 2026-05-01T00:30:00Z is not used: no reading is before it");
    CHECK_THAT(read.warnings[1], ContainsSubstring("no reading is between it and the step before"));
    CHECK_THAT(read.warnings[2], ContainsSubstring("no reading is after it"));
}
