#include <cmath>
#include <span>

#include "corrector/eemd/eemd.hpp"
#include "corrector/reading/band_pass.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/slow_signal.hpp"
#include "tests/support/plant_statistics.hpp"

using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace a351::sim {
namespace {

constexpr double kStep = IndoorRecord::kStepSeconds;
constexpr double kCycleSeconds = 900.0;  ///< Period of the publication's 15-minute band.

double mean_of(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// Returns the sum of products of deviations from the means.
double product(std::span<const double> x, std::span<const double> y) {
    const double mean_x = mean_of(x), mean_y = mean_of(y);
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mean_x) * (y[i] - mean_y);
    return sum;
}

/// Linear regression of y on x.
struct Regression {
    double slope = 0.0, r2 = 0.0;
};

Regression regress(std::span<const double> x, std::span<const double> y) {
    const double xx = product(x, x), xy = product(x, y), yy = product(y, y);
    return {xy / xx, xy * xy / (xx * yy)};
}

/// Returns the peak-to-peak value of a sine with the standard deviation of the values.
double swing(std::span<const double> values) {
    return 2.0 * std::sqrt(2.0 * product(values, values) / static_cast<double>(values.size()));
}

/// Returns the mean period between rising zero crossings.
double mean_period_s(const std::vector<double>& values) {
    std::size_t first = 0, last = 0;
    int count = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        if (values[i - 1] >= 0.0 || values[i] < 0.0) continue;
        if (count++ == 0) first = i;
        last = i;
    }
    return kStep * static_cast<double>(last - first) / (count - 1);
}

/// Returns the correlation of the temperature with the acceleration `lag` steps later.
double correlation(const IndoorRecord& record, int lag) {
    const auto shift = static_cast<std::size_t>(std::abs(lag));
    const std::span<const double> t(record.temperature_degc), a(record.difference_mgal);
    const auto x = lag >= 0 ? t.first(t.size() - shift) : t.subspan(shift);
    const auto y = lag >= 0 ? a.subspan(shift) : a.first(a.size() - shift);
    return product(x, y) / std::sqrt(product(x, x) * product(y, y));
}

/// Largest correlation of one sign between two lags, refined by a parabola.
struct Peak {
    double delay_s = 0.0, size = 0.0;
};

Peak find_peak(const IndoorRecord& record, double sign, int from, int to) {
    int best = from;
    for (int lag = from; lag <= to; ++lag) {
        if (sign * correlation(record, lag) > sign * correlation(record, best)) best = lag;
    }
    const double before = correlation(record, best - 1), here = correlation(record, best),
                 after = correlation(record, best + 1);
    const double shift = 0.5 * (before - after) / (before - 2.0 * here + after);
    return {kStep * (best + shift), std::abs(here - 0.25 * (before - after) * shift)};
}

constexpr int kHalfCycle = static_cast<int>(0.5 * kCycleSeconds / kStep);

/// Regresses the acceleration, with its sign reversed and moved 280 s earlier, on the temperature,
/// as published.
Regression turned_and_moved(const IndoorRecord& record) {
    constexpr std::size_t kEarlier = 14;  // 280 s.
    const std::span<const double> t(record.temperature_degc), a(record.difference_mgal);
    Regression regression = regress(t.first(t.size() - kEarlier), a.subspan(kEarlier));
    regression.slope = -regression.slope;
    return regression;
}

IndoorRecord in_band(const IndoorRecord& record) {
    constexpr double kShorter = 600.0, kLonger = 1500.0;
    return {corrector::reading::band_pass(record.temperature_degc, kStep, kShorter, kLonger),
            corrector::reading::band_pass(record.difference_mgal, kStep, kShorter, kLonger)};
}

/// Returns the mode whose mean period is nearest to the cycle, by ratio.
const corrector::eemd::Component& cycle_mode(const corrector::eemd::Result& result) {
    const corrector::eemd::Component* best = &result.modes.front();
    const auto distance = [](const corrector::eemd::Component& mode) {
        return std::abs(std::log(mode.mean_period_samples * kStep / kCycleSeconds));
    };
    for (const corrector::eemd::Component& mode : result.modes) {
        if (mode.extrema_count > 0 && distance(mode) < distance(*best)) best = &mode;
    }
    return *best;
}

void append(std::vector<Figure>& figures, const std::vector<double>& values) {
    for (std::size_t i = 0; i < figures.size(); ++i) figures[i].values.push_back(values[i]);
}

}  // namespace

IndoorRecord indoor_record(const Scenario& scenario, std::uint64_t seed) {
    const auto plan = plan_survey(scenario, seed);
    SlowSignal slow(scenario, plan, seed);
    constexpr int kSteps = static_cast<int>(kStep / SlowSignal::kStepSeconds);
    const auto means = static_cast<int>(seconds_between(scenario.start(), scenario.end()) / kStep);
    IndoorRecord record;
    for (int i = 0; i < means; ++i) {
        double temperature_degc = 0.0, difference_mgal = 0.0;
        for (int step = 0; step < kSteps; ++step) {
            const SlowValue value = slow.next();
            temperature_degc += value.temperature.value() / kSteps;
            difference_mgal +=
                ((value.along_vertical + value.along_z - *plan[0].site.gravity).value() -
                 value.terms_mgal[static_cast<std::size_t>(Term::tide)]) /
                kSteps;
        }
        record.temperature_degc.push_back(temperature_degc);
        record.difference_mgal.push_back(difference_mgal);
    }
    return record;
}

std::vector<Figure> indoor_figures(int seeds) {
    const Scenario scenario = load_scenario("indoor");
    std::vector<Figure> figures = {
        {"period of the temperature cycle [s]", "600-900", 700.0, 1050.0, {}},
        {"temperature swing [degC]", "0.02", 0.010, 0.025, {}},
        {"acceleration swing in the band [mGal]", "6", 3.5, 7.0, {}},
        {"raw slope [mGal/degC]", "131.82", 80.0, 180.0, {}},
        {"raw R2", "0.265", 0.15, 0.40, {}},
        {"band slope, sign turned, 280 s earlier [mGal/degC]", "256.89", 200.0, 310.0, {}},
        {"band R2", "0.464", 0.35, 0.65, {}},
        {"delay of the negative peak [s]", "240-280", 220.0, 300.0, {}},
        {"delay of the positive peak [s]", "other side", -260.0, -120.0, {}},
        {"positive peak by negative peak", "about 1", 0.9, 1.1, {}},
    };
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto record = indoor_record(scenario, static_cast<std::uint64_t>(seed));
        const IndoorRecord band = in_band(record);
        const Regression raw = regress(record.temperature_degc, record.difference_mgal);
        const Regression moved = turned_and_moved(band);
        const Peak negative = find_peak(band, -1.0, 0, kHalfCycle);
        const Peak positive = find_peak(band, 1.0, -kHalfCycle, 0);
        append(figures, {mean_period_s(band.temperature_degc), swing(band.temperature_degc),
                         swing(band.difference_mgal), raw.slope, raw.r2, moved.slope, moved.r2,
                         negative.delay_s, positive.delay_s, positive.size / negative.size});
    }
    return figures;
}

std::vector<Figure> indoor_eemd_figures(int seeds) {
    const Scenario scenario = load_scenario("indoor");
    std::vector<Figure> figures = {
        {"EEMD mode: slope, sign turned, 280 s earlier [mGal/degC]", "256.89", 180.0, 360.0, {}},
        {"EEMD mode: R2", "0.464", 0.2, 0.6, {}},
        {"EEMD mode: delay of the negative peak [s]", "240", 220.0, 300.0, {}},
        {"EEMD residue: slope [mGal/degC]", "positive", 0.0, 1e9, {}},
    };
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto record = indoor_record(scenario, static_cast<std::uint64_t>(seed));
        corrector::eemd::Options options;
        options.ensemble_size = 60;
        options.mode_count = 10;
        options.seed = static_cast<std::uint64_t>(seed);
        const auto temperature = corrector::eemd::eemd(record.temperature_degc, options);
        const auto acceleration = corrector::eemd::eemd(record.difference_mgal, options);
        const IndoorRecord mode{cycle_mode(temperature).values, cycle_mode(acceleration).values};
        const Regression moved = turned_and_moved(mode);
        append(figures, {moved.slope, moved.r2, find_peak(mode, -1.0, 0, kHalfCycle).delay_s,
                         regress(temperature.residue.values, acceleration.residue.values).slope});
    }
    return figures;
}

}  // namespace a351::sim
