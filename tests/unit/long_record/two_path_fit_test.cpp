/// The two-path fit, compared with the true parameters of units drawn around the scenarios' values.
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "tests/support/two_path_truth.hpp"
#include "tests/unit/long_record/simulated_record.hpp"

using namespace a351;
using namespace a351::corrector::long_record;

namespace {

constexpr double k95 = 1.96;  // standard errors

std::string words(const TwoPathFit& fit, const sim::TwoPathTruth& truth, TwoPathTerm term) {
    const FittedParameter& parameter = fit[term];
    return parameter.key + ' ' + std::to_string(parameter.value) + " +- " +
           std::to_string(parameter.standard_error) + ", true " + std::to_string(truth[term]) +
           (parameter.is_determined ? "" : " (not determined)");
}

}  // namespace

TEST_CASE("95 % limits of a night's fit contain the true parameters") {
    constexpr int kSeeds = 20;
    const sim::scenario::Scenario scenario = of_drawn_units("indoor");
    int fast_determined = 0, static_held = 0, adequate = 0;
    double static_square = 0.0;
    std::map<TwoPathTerm, int> held;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const TwoPathFit fit = fitted(scenario, seed);
        const sim::TwoPathTruth truth = sim::two_path_truth(scenario, seed);
        for (std::size_t k = 0; k < kTwoPathTerms; ++k) {
            const auto term = static_cast<TwoPathTerm>(k);
            UNSCOPED_INFO(seed << ' ' << words(fit, truth, term));
            held[term] += std::abs(sim::deviation(fit, truth, term)) <= k95 ? 1 : 0;
        }
        const double off = sim::static_slope_deviation(fit, truth);
        static_held += std::abs(off) <= k95 ? 1 : 0;
        static_square += off * off / kSeeds;
        fast_determined += fit[TwoPathTerm::fast].is_determined ? 1 : 0;
        adequate += fit.unexplained.empty() ? 1 : 0;
        // A night determines neither the two slopes nor their sum, and the fit says so.
        CHECK_FALSE(fit[TwoPathTerm::slow_lag].is_determined);
        CHECK_FALSE(fit[TwoPathTerm::slow_lag].needed.empty());
        CHECK_FALSE(fit.is_static_slope_determined);
    }
    CHECK(fast_determined == kSeeds);
    CHECK(adequate >= 18);
    CHECK(static_held >= 17);
    CHECK(static_square < 1.0);
    for (const auto& [term, count] : held) {
        CAPTURE(static_cast<int>(term));
        CHECK(count >= 17);  // 85 % of 20
    }
}

TEST_CASE("a week has smaller errors than a night and determines the static slope") {
    const sim::scenario::Scenario scenario = of_drawn_units("week");
    const TwoPathFit night = fitted(of_drawn_units("indoor"), 1), week = fitted(scenario, 1);
    const sim::TwoPathTruth truth = sim::two_path_truth(scenario, 1);
    for (std::size_t k = 0; k < kTwoPathTerms; ++k) {
        const auto term = static_cast<TwoPathTerm>(k);
        CAPTURE(words(week, truth, term), night[term].standard_error);
        CHECK(week[term].standard_error < night[term].standard_error);
        CHECK(std::abs(sim::deviation(week, truth, term)) < 3.0);
    }
    CHECK(week.is_static_slope_determined);
    CHECK(std::abs(sim::static_slope_deviation(week, truth)) < 3.0);
    // A week is fourteen times as long; the error of the fast path falls with the square root.
    CHECK(week[TwoPathTerm::fast].standard_error < 0.6 * night[TwoPathTerm::fast].standard_error);
}

TEST_CASE("slopes and lag of an outer oven are found, and are missing without one") {
    const RecordSegment segment = simulated_segment(of_drawn_units("indoor"), 7);
    std::vector<double> outer, reading = segment.quantity;
    for (std::size_t i = 0; i < segment.size(); ++i) {
        const double time_h = static_cast<double>(i) * kRecordStep_s / 3600.0;
        outer.push_back(38.0 + 0.6 * std::sin(1.3 * time_h) + 0.6 * std::sin(25.0 * time_h));
    }
    const auto effect =
        unit::lagged(TimeSeries<DegC>({}, Hertz(1.0 / kRecordStep_s), outer), 900.0);
    for (std::size_t i = 0; i < reading.size(); ++i)
        reading[i] += 5.0 * outer[i] + 15.0 * effect[i];
    const auto fit = [&](const std::vector<double>& degc) {
        return fit_two_paths(segment.temperature_degc, reading, kRecordStep_s, 900.0, degc);
    };
    const TwoPathFit seen = fit(outer), unseen = fit({});
    REQUIRE(seen.parameters.size() == kTwoPathTerms + 3);
    const double truth[] = {5.0, 15.0, 900.0};
    for (std::size_t k = 0; k < std::size(truth); ++k) {
        const FittedParameter& found = seen.parameters[kTwoPathTerms + k];
        CAPTURE(found.key, found.value, found.standard_error);
        CHECK(found.is_determined);
        CHECK(found.standard_error < 0.2 * truth[k]);
        CHECK(std::abs(found.value - truth[k]) < 3.0 * found.standard_error);
    }
    CHECK(seen.residual_rms_mgal < 0.5 * unseen.residual_rms_mgal);
    CHECK(unseen.parameters.size() == kTwoPathTerms);
}

TEST_CASE("the thermometer's noise gives no information on the static slope") {
    // The same night without that noise must leave the slope as uncertain: a trend that leaks into
    // the frequencies of the noise must not get the weight of those frequencies.
    sim::scenario::Scenario quiet = of_drawn_units("indoor");
    const TwoPathFit noisy = fitted(quiet, 101);
    quiet.slow_noise.temperature_degc = 0.0001;
    const TwoPathFit fit = fitted(quiet, 101);
    CAPTURE(fit.static_slope, noisy.static_slope);
    CHECK(noisy.static_slope_error > 0.9 * fit.static_slope_error);
}

TEST_CASE("true fluctuations at 85 s are not taken for the thermometer's noise") {
    const unit::ThermalEffect unit{-12.0, -20.0, 11.3};
    int held = 0;
    constexpr int kRecords = 20;
    for (unsigned record = 1; record <= kRecords; ++record) {
        std::mt19937_64 random(record);
        std::normal_distribution<double> normal;
        // Resonances near 900 s and near 85 s: x_i = a x_(i-1) - b x_(i-2) + noise
        double cycle = 0.0, before_cycle = 0.0, fast = 0.0, before_fast = 0.0;
        std::vector<double> truth, shown;
        for (int i = 0; i < 4320; ++i) {
            before_cycle =
                std::exchange(cycle, 1.92 * cycle - 0.94 * before_cycle + 0.0003 * normal(random));
            before_fast =
                std::exchange(fast, 0.16 * fast - 0.9 * before_fast + 0.0015 * normal(random));
            truth.push_back(42.5 + cycle + fast);
            shown.push_back(truth.back() + 0.0015 * normal(random));
        }
        std::vector<double> acceleration = unit.of({{}, Hertz(1.0 / kRecordStep_s), truth}, 42.5);
        for (double& value : acceleration) value += 0.4 * normal(random);
        const TwoPathFit fit = fit_two_paths(shown, acceleration, kRecordStep_s, 900.0);
        const FittedParameter& rate = fit[TwoPathTerm::fast];
        UNSCOPED_INFO(rate.value << " +- " << rate.standard_error);
        held += std::abs(rate.value - unit.fast) <= k95 * rate.standard_error ? 1 : 0;
    }
    CHECK(held >= 17);
}

TEST_CASE("a thermometer that shows its noise alone determines no path") {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (int record = 0; record < 20; ++record) {
        std::vector<double> temperature, acceleration;
        for (int i = 0; i < 2160; ++i) {
            temperature.push_back(42.5 + 0.0015 * normal(random));
            acceleration.push_back(1.5 * normal(random));
        }
        const TwoPathFit fit = fit_two_paths(temperature, acceleration, kRecordStep_s, 900.0);
        CAPTURE(record, fit[TwoPathTerm::fast].value, fit[TwoPathTerm::fast].standard_error);
        for (const TwoPathTerm term : {TwoPathTerm::level, TwoPathTerm::fast, TwoPathTerm::slow,
                                       TwoPathTerm::fast_lag, TwoPathTerm::slow_lag})
            CHECK_FALSE(fit[term].is_determined);
        CHECK_FALSE(fit.is_static_slope_determined);
    }
}

TEST_CASE("a response that the model does not contain is found in the residual") {
    RecordSegment segment = simulated_segment("indoor", 1);
    // A delay of 700 s, which no first-order lag can give at 900 s.
    for (std::size_t i = segment.size() - 1; i >= 35; --i)
        segment.quantity[i] +=
            400.0 * (segment.temperature_degc[i - 35] - segment.temperature_degc[i]);
    const TwoPathFit fit =
        fit_two_paths(segment.temperature_degc, segment.quantity, kRecordStep_s, 900.0);
    CAPTURE(fit[TwoPathTerm::fast].value, fit[TwoPathTerm::fast_lag].value);
    CHECK_FALSE(fit.unexplained.empty());
}
