#include "corrector/design/planned_day.hpp"

#include <cmath>

#include "corrector/reading/survey_row.hpp"
#include "tests/unit/design/made_up_plan.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::design;

TEST_CASE("the usual walk of the oven is that of the published survey day") {
    const auto sites = text::read_sites(A351_GOLDEN "/tsukuba/sites.csv");
    const auto rows = reading::read_observations(A351_GOLDEN "/tsukuba/observations.csv", sites);
    double sum = 0.0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const double change = (rows[i].temperature - rows[i - 1].temperature).value();
        sum += change * change / (seconds_between(rows[i - 1].time, rows[i].time) / 3600.0);
    }
    const double walk = std::sqrt(sum / static_cast<double>(rows.size() - 1));
    INFO("rms " << walk << " degC per square root of an hour over " << rows.size() << " readings");
    CHECK(walk == Approx(kUsualWalk_degc_per_sqrt_h).margin(0.0005));
}

TEST_CASE("a planned temperature changes like a random walk") {
    const UtcTime start = *parse_rfc3339("2026-05-01T00:00:00Z");
    constexpr double kWalk = 0.2;
    for (const double hours : {0.5, 1.0, 3.0, 8.0}) {
        double sum = 0.0, count = 0.0;
        for (std::size_t course = 0; course < kCourses; ++course) {
            const auto series =
                planned_temperature(start, start + std::chrono::hours(20), kWalk, course);
            const auto lag = static_cast<std::size_t>(hours * 1800.0);
            for (std::size_t i = 0; i + lag < series.size(); i += 50) {
                sum += std::pow((series[i + lag] - series[i]).value(), 2);
                count += 1.0;
            }
        }
        const double found = std::sqrt(sum / count / hours);
        INFO(found << " degC per square root of an hour over " << hours << " h");
        CHECK(found == Approx(kWalk).epsilon(0.15));
    }
}

TEST_CASE("a planned day has the bins of its set-ups without their ends") {
    const PlannedDay day =
        planned_day(made_up_plan("ABCA", 2, 6.0), made_up_sites(), usual_unit(), 0);
    CHECK(day.sites == std::vector<std::string>{"A", "B", "C"});
    REQUIRE(day.stations.size() == 8);
    CHECK(day.stations[7].number == 0);
    CHECK(day.stations[7].gravity == MilliGal(979800.0));
    CHECK_FALSE(day.stations[2].gravity.has_value());
    const auto& bins = day.record.bins;
    CHECK(to_rfc3339(bins.front().times.front()) == "2026-05-01T00:00:26Z");
    std::size_t of_second = 0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        CHECK(bins[i].times.size() >= 8);
        if (i > 0) CHECK(bins[i].time > bins[i - 1].time);
        if (bins[i].set_up != 1) continue;
        ++of_second;
        CHECK(bins[i].times.front() >= *parse_rfc3339("2026-05-01T00:06:25Z"));
        CHECK(bins[i].times.back() <= *parse_rfc3339("2026-05-01T00:11:35Z"));
    }
    CHECK(of_second == 6);  // 155 samples of 2 s: six bins of 25, and one of 5 is too short
}

TEST_CASE("the tilts of the set-ups have the scatter of the unit") {
    const PlannedUnit unit = usual_unit();
    double x = 0.0, y = 0.0, count = 0.0;
    for (std::size_t course = 0; course < kCourses; ++course) {
        const PlannedDay day = planned_day(made_up_plan(), made_up_sites(), unit, course);
        for (const reading::DayBin& bin : day.record.bins) {
            x += std::pow(bin.x.value(), 2);
            y += std::pow(bin.y.value(), 2);
            count += 1.0;
        }
    }
    CHECK(std::sqrt(x / count) == Approx(unit.tilt_g).epsilon(0.1));
    CHECK(std::sqrt(y / count) == Approx(unit.tilt_g).epsilon(0.1));
}
