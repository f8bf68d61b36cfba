#include "sim/signal/set_up_truth.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/units.hpp"
#include "protocol/text/csv.hpp"
#include "sim/signal/disturbance.hpp"
#include "sim/signal/signal_source.hpp"

namespace a351::sim::signal {
namespace {

using Vector = std::array<double, 3>;

constexpr std::array<const char*, kTermCount> kTermColumns = {
    "tide_mgal",    "bias_mgal",      "static_mgal",  "dynamic_mgal",    "clock_mgal",
    "warm_up_mgal", "placement_mgal", "flicker_mgal", "resonant_mgal",   "white_mgal",
    "drift_mgal",   "ripple_mgal",    "scale_mgal",   "outer_oven_mgal", "turn_mgal"};

/// Rounds a mean to 1e-5, the resolution of the table.
double rounded(double value) {
    constexpr double kSteps = 1e5;
    return std::floor(value * kSteps + 0.5) / kSteps;
}

/// Returns the time left out at either end, because handling disturbs it.
Nanoseconds margin(const scenario::PlannedSetUp& set_up) {
    return std::min<Nanoseconds>(std::chrono::minutes(1), (set_up.end - set_up.start) / 4);
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Returns the means of the slow signal over each set-up.
std::vector<SetUpTruth> slow_means(const scenario::Scenario& scenario,
                                   const std::vector<scenario::PlannedSetUp>& plan,
                                   std::uint64_t seed) {
    std::vector<SetUpTruth> truth(plan.size());
    std::vector<int> counts(plan.size());
    SlowSignal slow(scenario, plan, seed);
    UtcTime now = scenario.start();
    while (now < plan.back().end) {
        const SlowValue value = slow.next();
        const scenario::PlannedSetUp& set_up = plan[value.set_up];
        const UtcTime start = set_up.start + margin(set_up);
        if (start <= now && now < set_up.end - margin(set_up)) {
            SetUpTruth& sums = truth[value.set_up];
            sums.ambient_degc += value.ambient.value();
            sums.temperature_degc += value.temperature.value();
            for (std::size_t i = 0; i < kTermCount; ++i) sums.terms_mgal[i] += value.terms_mgal[i];
            ++counts[value.set_up];
        }
        now += from_seconds(SlowSignal::kStepSeconds);
    }
    for (std::size_t i = 0; i < plan.size(); ++i) {
        truth[i].ambient_degc /= counts[i];
        truth[i].temperature_degc /= counts[i];
        for (double& term : truth[i].terms_mgal) term /= counts[i];
    }
    return truth;
}

/// Adds the terms that do not follow from the vertical component alone: biases, bursts, and noise
/// across the vertical.
void add_vector_terms(const scenario::Scenario& scenario, const scenario::PlannedSetUp& set_up,
                      const Vector& bias_mgal, Disturbances& disturbances, SetUpTruth& truth) {
    const Vector vertical = tilted_vertical(set_up);
    double force_mgal = set_up.site.gravity->value();
    for (const double term : truth.terms_mgal) force_mgal += term;
    const double along_vertical_mgal = set_up.site.gravity->value() +
                                       truth.terms_mgal[static_cast<std::size_t>(Term::tide)] +
                                       truth.terms_mgal[static_cast<std::size_t>(Term::ripple)];
    Vector total_mgal = bias_mgal;
    for (std::size_t i = 0; i < 3; ++i) total_mgal[i] += vertical[i] * along_vertical_mgal;
    total_mgal[2] += set_up.face * (force_mgal - along_vertical_mgal);
    truth.tilt_mgal = std::sqrt(dot(total_mgal, total_mgal)) - force_mgal;

    constexpr double kRate = Source::kRateHz;
    const auto first = static_cast<std::int64_t>(
        std::ceil(kRate * seconds_between(scenario.start(), set_up.start + margin(set_up))));
    const auto last = static_cast<std::int64_t>(
        std::ceil(kRate * seconds_between(scenario.start(), set_up.end - margin(set_up))));
    double across_mgal2 = 0.0;
    for (std::int64_t i = first; i < last; ++i) {
        Vector burst_mgal{};
        disturbances.add_to(burst_mgal, static_cast<double>(i) / kRate);
        const double along_mgal = dot(burst_mgal, vertical);
        truth.burst_mgal += along_mgal;
        across_mgal2 += dot(burst_mgal, burst_mgal) - along_mgal * along_mgal;
    }
    const auto count = static_cast<double>(last - first);
    truth.burst_mgal /= count;
    const double ground_mgal = scenario.vibration.ground_mgal;
    const double white_mgal = scenario.sensor.white_mgal;
    constexpr double kHorizontalAxes = 2.0;
    truth.rectification_mgal =
        (across_mgal2 / count +
         kHorizontalAxes * (ground_mgal * ground_mgal + white_mgal * white_mgal)) /
        (2.0 * force_mgal);
}

}  // namespace

std::vector<SetUpTruth> set_up_truth(const scenario::Scenario& scenario,
                                     const std::vector<scenario::PlannedSetUp>& plan,
                                     std::uint64_t seed) {
    if (!plan.front().is_occupied) return {};
    std::vector<SetUpTruth> truth = slow_means(scenario, plan, seed);
    const Vector bias_mgal = axis_bias_mgal(scenario, seed);
    Disturbances disturbances(draw_bursts(scenario, plan, seed));
    for (std::size_t i = 0; i < plan.size(); ++i)
        add_vector_terms(scenario, plan[i], bias_mgal, disturbances, truth[i]);
    return truth;
}

std::string truth_csv(const scenario::Scenario& scenario,
                      const std::vector<scenario::PlannedSetUp>& plan, std::uint64_t seed) {
    using text::shortest;
    std::string csv =
        "site,occupation,start_utc,end_utc,gravity_mgal,used,set_up,ambient_degc,"
        "temperature_degc,about_y_deg,about_x_deg";
    // A day without an outer oven or without turns has no such columns.
    const bool has_two_faces = scenario.schedule.faces.find('-') != std::string::npos;
    std::vector<std::size_t> terms;
    for (std::size_t k = 0; k < kTermCount; ++k)
        if ((static_cast<Term>(k) != Term::outer_oven || scenario.outer_oven) &&
            (static_cast<Term>(k) != Term::turn || has_two_faces))
            terms.push_back(k);
    for (const std::size_t k : terms) csv += fmt::format(",{}", kTermColumns[k]);
    csv += ",tilt_mgal,burst_mgal,rectification_mgal";
    csv += has_two_faces ? ",face\n" : "\n";
    const std::vector<SetUpTruth> truth = set_up_truth(scenario, plan, seed);
    const std::vector<scenario::PlannedSetUp> rows = by_true_time(scenario, plan, seed);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const scenario::PlannedSetUp& set_up = rows[i];
        const SetUpTruth& mean = truth[i];
        csv += fmt::format("{},{},{},{},{},{},{}", set_up.site.name, set_up.number,
                           to_rfc3339(set_up.start, 3), to_rfc3339(set_up.end, 3),
                           shortest(set_up.site.gravity->value()), set_up.is_outlier ? 0 : 1,
                           set_up.part);
        const auto cell = [&csv](double value) { csv += "," + shortest(rounded(value)); };
        cell(mean.ambient_degc);
        cell(mean.temperature_degc);
        cell(set_up.about_y_rad * kDegPerRad);
        cell(set_up.about_x_rad * kDegPerRad);
        for (const std::size_t k : terms) cell(mean.terms_mgal[k]);
        cell(mean.tilt_mgal);
        cell(mean.burst_mgal);
        cell(mean.rectification_mgal);
        if (has_two_faces) csv += set_up.face < 0.0 ? ",-" : ",+";
        csv += "\n";
    }
    return csv;
}

}  // namespace a351::sim::signal
