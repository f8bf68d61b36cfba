/// Simulated nights indoors, analysed by the product: means over seeds of the statistics that the
/// publication gives (Matsuda et al., tests/golden/tsukuba/README.md).
#include <cmath>
#include <map>

#include "corrector/long_record/record_result.hpp"
#include "tests/support/published_ranges.hpp"
#include "tests/unit/long_record/simulated_record.hpp"

using namespace a351;
using namespace a351::corrector::long_record;

TEST_CASE("simulated nights have the statistics of the night in the publication") {
    constexpr int kSeeds = 10;
    std::map<std::string, double> means;
    for (int seed = 1; seed <= kSeeds; ++seed) {
        RecordResult result;
        result.parts.segments.push_back(
            simulated_segment("indoor", static_cast<std::uint64_t>(seed)));
        result.options.ensemble_size = 60;
        result.analysis = analyse_record(result.segment(), kRecordStep_s, result.options);
        CHECK(result.analysis.modes.has_value());
        for (const RecordStatistic& statistic : record_statistics(result))
            means[statistic.key] += statistic.value / kSeeds;
    }
    for (const sim::PublishedRange& range : sim::kPublishedRanges) {
        CAPTURE(range.key);
        CHECK(means.at(std::string(range.key)) >= range.low);
        CHECK(means.at(std::string(range.key)) <= range.high);
    }
}

TEST_CASE("two correlation peaks of one narrow band are interpreted as one response") {
    // 257 mGal/degC, negative and 260 s late at 900 s, with nothing else: 9.9 mGal per degC/h.
    std::vector<double> temperature, acceleration;
    for (int i = 0; i < 2160; ++i) {
        const double time_s = 20.0 * i, angular_hz = 2.0 * M_PI / 900.0;
        temperature.push_back(0.01 * std::sin(angular_hz * time_s));
        acceleration.push_back(-2.57 * std::sin(angular_hz * (time_s - 260.0)));
    }
    const PairStatistics pair = pair_statistics(temperature, acceleration, 20.0, 900.0, 280.0);
    CHECK(pair.correlation.negative.delay_s == Approx(260.0).margin(1.0));
    CHECK(pair.correlation.positive.delay_s == Approx(-190.0).margin(1.0));
    CHECK(phase_of_peaks_deg(pair) == Approx(76.0).margin(0.5));
    CHECK(rate_coefficient(pair) == Approx(9.9).margin(0.1));
    CHECK_THAT(causal_reading(pair),
               ContainsSubstring("rate of change") && ContainsSubstring("before the thermometer"));
}

TEST_CASE("a record shorter than eight cycles is not analysed") {
    RecordSegment segment;
    segment.quantity.assign(359, 1.0);
    segment.temperature_degc.assign(359, 1.0);
    CHECK_THROWS_AS(analyse_record(segment, kRecordStep_s, {}), std::invalid_argument);
}

TEST_CASE("a record without a cycle is not interpreted as if it had one") {
    RecordSegment segment;
    for (int i = 0; i < 1200; ++i) {
        segment.temperature_degc.push_back(42.5 + 1e-4 * i);
        segment.quantity.push_back(979763.0 + 0.01 * i + 0.1 * std::sin(0.7 * i * i));
    }
    RecordAnalysisOptions options;
    options.ensemble_size = 4;
    CHECK_THAT(analyse_record(segment, kRecordStep_s, options).reading,
               StartsWith("In the band of 900 s this record shows no response") &&
                   ContainsSubstring("needed: "));
}
