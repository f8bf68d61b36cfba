/// The two-path fit against the parameters of the scenarios.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "corrector/fixed_point/two_path_fit.hpp"
#include "tests/unit/fixed_point/simulated_record.hpp"

using namespace a351;
using namespace a351::corrector;

namespace {

/// sim: fast 950 mGal/degC x 43 s, in mGal/(degC/h); indoor: no drift.
const std::map<TwoPathTerm, double> kTrue{{TwoPathTerm::level, -12.0},
                                          {TwoPathTerm::fast, 950.0 * 43.0 / 3600.0},
                                          {TwoPathTerm::slow, -20.0},
                                          {TwoPathTerm::fast_lag, 43.0},
                                          {TwoPathTerm::slow_lag, 2700.0}};

TwoPathFit fitted(const std::string& scenario, std::uint64_t seed) {
    const RecordSegment segment = simulated_segment(scenario, seed);
    return fit_two_paths(segment.temperature_degc, segment.acceleration_mgal, kRecordStep_s, 900.0);
}

}  // namespace

TEST_CASE("95 % limits of a night's fit hold the true parameters", "[fixed_point][two_paths]") {
    constexpr int kSeeds = 10;
    int fast_determined = 0;
    std::map<TwoPathTerm, int> held;
    int static_held = 0, adequate = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const TwoPathFit fit = fitted("indoor", seed);
        for (const auto& [term, truth] : kTrue) {
            const FittedParameter& parameter = fit[term];
            UNSCOPED_INFO(seed << ' ' << parameter.key << ' ' << parameter.value << " +- "
                               << parameter.standard_error
                               << (parameter.is_determined ? "" : " (not determined)"));
            const bool is_lag = term == TwoPathTerm::fast_lag || term == TwoPathTerm::slow_lag;
            const double deviation = is_lag ? std::log(parameter.value / truth) * parameter.value
                                            : parameter.value - truth;
            held[term] += std::abs(deviation) <= 1.96 * parameter.standard_error ? 1 : 0;
        }
        static_held += std::abs(fit.static_slope + 32.0) <= 1.96 * fit.static_slope_error ? 1 : 0;
        fast_determined += fit[TwoPathTerm::fast].is_determined ? 1 : 0;
        adequate += fit.unexplained.empty() ? 1 : 0;
        // A night cannot part the slopes, and says so.
        CHECK_FALSE(fit[TwoPathTerm::slow_lag].is_determined);
        CHECK_FALSE(fit[TwoPathTerm::slow_lag].needed.empty());
    }
    CHECK(fast_determined == kSeeds);
    CHECK(adequate >= 9);
    CHECK(static_held >= 8);
    for (const auto& [term, count] : held) {
        CAPTURE(static_cast<int>(term));
        CHECK(count >= 8);  // 85 % of 10, with the scatter of ten
    }
}

TEST_CASE("a week narrows what a night leaves open", "[fixed_point][two_paths]") {
    const TwoPathFit night = fitted("indoor", 1), week = fitted("week", 1);
    for (const auto& [term, truth] : kTrue) {
        CAPTURE(week[term].key, week[term].value, week[term].standard_error,
                night[term].standard_error);
        CHECK(week[term].standard_error < night[term].standard_error);
        CHECK(std::abs(week[term].value - truth) < 3.0 * week[term].standard_error);
    }
    CHECK(week.static_slope == Approx(-32.0).margin(3.0 * week.static_slope_error));
    // Fourteen times as long: the fast path by its root.
    CHECK(week[TwoPathTerm::fast].standard_error < 0.6 * night[TwoPathTerm::fast].standard_error);
}

TEST_CASE("a response that the model does not have is found in the residual",
          "[fixed_point][two_paths]") {
    RecordSegment segment = simulated_segment("indoor", 1);
    // A delay of 700 s: no first-order lag does that at 900 s.
    for (std::size_t i = segment.size() - 1; i >= 35; --i)
        segment.acceleration_mgal[i] +=
            400.0 * (segment.temperature_degc[i - 35] - segment.temperature_degc[i]);
    const TwoPathFit fit =
        fit_two_paths(segment.temperature_degc, segment.acceleration_mgal, kRecordStep_s, 900.0);
    CAPTURE(fit[TwoPathTerm::fast].value, fit[TwoPathTerm::fast_lag].value);
    CHECK_FALSE(fit.unexplained.empty());
}
