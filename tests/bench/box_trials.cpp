/// Measures the adjustment of several sensors in one box on simulated days, and the split of the
/// placement.
///
///     box-trials FIRST_SEED DAYS
///
/// Share: the true share of the placement's variance that the sensors have in common.  A day is
/// `tilted` (axis biases of up to 2 Gal, which nobody has measured) with two set-ups of six minutes in
/// each stay, sensors within +-25 % of the emulator's, and gravity known at No.0, No.7 and No.12.  The
/// readings are the plant's slow signals once a second, with the sensor's noise and tilt.  Bursts,
/// ground noise and the thermometer's noise are left out: the decimation removes them.
///
/// Prints a line for each day, and one for each box: the rms error at the unknown stations and the rms
/// of its uncertainty in mGal, their ratio with its 95 % limits from 2000 draws of days, and on how
/// many days the share was within its 95 % limits.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "corrector/whole_day/day_model.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/earth_tide.hpp"
#include "sim/signal/signal_source.hpp"

namespace {

using namespace a351;
using namespace a351::corrector;

const std::vector<std::string> kKnown{"No.0", "No.7", "No.12"};
constexpr std::uint64_t kAnotherSensor = 1'000'000;  // far from the seeds of the first sensors
constexpr double kHandling_s = 25.0;                 // at both ends, as `design` plans it
constexpr double kSample_s = 2.0;
constexpr std::pair<std::size_t, double> kBoxes[] = {
    {1, 0.0}, {2, 0.0}, {2, 0.5}, {2, 1.0}, {4, 0.0}, {4, 0.5}, {4, 1.0}};  // sensors, share

sim::scenario::Scenario scenario_of(std::uint64_t box, double share) {
    return sim::scenario::parse_scenario(
        fmt::format("base = \"tilted\"\nname = \"box\"\n[schedule]\nsetups = 2\n"
                    "[temperature_error]\nunit_scatter = 0.25\n"
                    "[box]\nseed = {}\nplacement_share = {}\n",
                    box, share),
        "box.toml");
}

/// Returns the day as one sensor records it.
reading::DayRecord record_of(const sim::scenario::Scenario& scenario,
                             const std::vector<sim::scenario::PlannedSetUp>& plan,
                             std::uint64_t seed) {
    sim::signal::SlowSignal slow(scenario, plan, seed);
    sim::noise::RandomStream white(seed, "white of bins");
    const auto bias_mgal = sim::signal::axis_bias_mgal(scenario, seed);
    std::vector<double> degc;
    std::vector<reading::DayBin> bins;
    const auto end = static_cast<int>(seconds_between(scenario.start(), scenario.end()));
    for (int second = 0; second < end; second += 2) {
        const auto value = slow.next();
        static_cast<void>(slow.next());
        degc.push_back(value.temperature.value());
        const UtcTime now = scenario.start() + from_seconds(second);
        const sim::scenario::PlannedSetUp& set_up = plan[value.set_up];
        if (now < set_up.start + from_seconds(kHandling_s) ||
            now > set_up.end - from_seconds(kHandling_s))
            continue;
        const auto vertical = sim::signal::tilted_vertical(set_up);
        const double along_mgal = value.along_vertical.value();
        std::array<double, 3> axes = bias_mgal;
        for (std::size_t i = 0; i < axes.size(); ++i) axes.at(i) += vertical.at(i) * along_mgal;
        axes[2] += value.along_z.value();
        const double norm_mgal =
            std::sqrt(axes[0] * axes[0] + axes[1] * axes[1] + axes[2] * axes[2]);
        if (bins.empty() || bins.back().set_up != value.set_up ||
            bins.back().times.size() == reading::kBinSamples) {
            bins.emplace_back();
            bins.back().set_up = value.set_up;
        }
        reading::DayBin& bin = bins.back();
        const auto add = [&bin](double& mean, double one) {
            mean += (one - mean) / static_cast<double>(bin.times.size());
        };
        bin.times.push_back(now);
        double reading = bin.reading.value(), x = bin.x.value(), y = bin.y.value();
        // A value is the mean of 100 samples.
        add(reading, norm_mgal + scenario.sensor.white_mgal / 10.0 * white.normal());
        add(x, axes[0] / kMilliGalPerStandardGravity);
        add(y, axes[1] / kMilliGalPerStandardGravity);
        bin.reading = MilliGal(reading);
        bin.x = StandardGravity(x);
        bin.y = StandardGravity(y);
    }
    std::erase_if(bins, [](const reading::DayBin& bin) { return bin.times.size() < 8; });
    for (reading::DayBin& bin : bins) {
        bin.time = bin.times.front() + (bin.times.back() - bin.times.front()) / 2;
        const text::Site& site = plan[bin.set_up].site;
        bin.tide = sim::signal::earth_tide(site.latitude, site.longitude, site.altitude, bin.time,
                                           scenario.tide.gravimetric_factor);
    }
    return {{TimeSeries<DegC>(scenario.start(), Hertz(1.0 / kSample_s), degc), {}}, bins};
}

/// Errors at the unknown stations of a simulated day.
struct Trial {
    std::vector<double> errors_mgal, u_mgal;
    bool is_share_inside = true;
};

Trial try_box(std::uint64_t seed, std::size_t sensors, double share) {
    const sim::scenario::Scenario scenario = scenario_of(seed, share);
    std::vector<std::vector<sim::scenario::PlannedSetUp>> plans;
    std::vector<reading::DayRecord> records;
    for (std::size_t k = 0; k < sensors; ++k) {
        const std::uint64_t own = seed + k * kAnotherSensor;
        plans.push_back(sim::scenario::plan_survey(scenario, own));
        records.push_back(record_of(scenario, plans.back(), own));
    }
    std::map<std::string, std::size_t> numbers;
    std::vector<whole_day::DayStation> stations;
    std::vector<double> truth_mgal;
    std::vector<bool> is_known;
    for (const auto& set_up : plans.front()) {
        const auto [place, is_new] = numbers.emplace(set_up.site.name, numbers.size());
        const bool is_held = std::ranges::find(kKnown, set_up.site.name) != kKnown.end();
        if (is_new) truth_mgal.push_back(set_up.site.gravity->value());
        if (is_new) is_known.push_back(is_held);
        whole_day::DayStation station{std::nullopt, place->second};
        if (is_held) station.gravity = set_up.site.gravity;
        stations.push_back(station);
    }
    std::vector<std::size_t> same(numbers.size());
    for (std::size_t k = 0; k < same.size(); ++k) same[k] = k;
    std::vector<whole_day::DaySurvey> surveys;
    for (std::size_t k = 0; k < sensors; ++k)
        surveys.push_back({&records[k], stations, whole_day::usual_day_priors(), same, k});
    const whole_day::DayAdjustment fit = whole_day::adjust_days(surveys);
    Trial trial;
    for (std::size_t k = 0; k < same.size(); ++k) {
        if (is_known[k]) continue;
        const whole_day::Estimate gravity = fit.gravity(k);
        trial.errors_mgal.push_back(gravity.value - truth_mgal[k]);
        trial.u_mgal.push_back(gravity.standard_error);
    }
    const double placement_mgal = fit.fit().noise.placement_mgal;
    fmt::print("{}: placement {:.2f}", seed, placement_mgal);
    if (fit.share()) {
        trial.is_share_inside = fit.share()->lowest <= share && share <= fit.share()->highest;
        fmt::print(", share {:.2f} (expected {:.2f}, {:.2f} to {:.2f}{})", fit.share()->most_likely,
                   fit.share()->expected, fit.share()->lowest, fit.share()->highest,
                   trial.is_share_inside ? "" : ", outside");
    }
    return trial;
}

double rms_of(const std::vector<Trial>& trials, std::vector<double> Trial::*values) {
    double squares = 0.0, count = 0.0;
    for (const Trial& trial : trials)
        for (const double value : trial.*values) {
            squares += value * value;
            count += 1.0;
        }
    return std::sqrt(squares / count);
}

/// Prints the row of a box.
void show(std::uint64_t first, std::uint64_t days, std::size_t sensors, double share) {
    std::vector<Trial> trials;
    for (std::uint64_t seed = first; seed < first + days; ++seed) {
        trials.push_back(try_box(seed, sensors, share));
        fmt::print(", rms error {:.2f}, u {:.2f}\n", rms_of({trials.back()}, &Trial::errors_mgal),
                   rms_of({trials.back()}, &Trial::u_mgal));
        std::fflush(stdout);
    }
    std::mt19937_64 random(1);
    std::vector<double> errors, ratios;
    for (int draw = 0; draw < 2000; ++draw) {
        std::vector<Trial> drawn;
        for (std::size_t k = 0; k < trials.size(); ++k)
            drawn.push_back(trials[random() % trials.size()]);
        errors.push_back(rms_of(drawn, &Trial::errors_mgal));
        ratios.push_back(errors.back() / rms_of(drawn, &Trial::u_mgal));
    }
    std::ranges::sort(errors);
    std::ranges::sort(ratios);
    const double error = rms_of(trials, &Trial::errors_mgal), u = rms_of(trials, &Trial::u_mgal);
    fmt::print("{:7} {:>6} {:5.2f} ({:.2f} to {:.2f}) {:9.2f} {:5.2f} ({:.2f} to {:.2f}) {:>13}\n",
               sensors, sensors > 1 ? fmt::format("{}", share) : "-", error, errors[49],
               errors[1949], u, error / u, ratios[49], ratios[1949],
               sensors > 1
                   ? fmt::format("{}", std::ranges::count(trials, true, &Trial::is_share_inside))
                   : "-");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: box-trials FIRST_SEED DAYS\n");
        return 2;
    }
    const std::uint64_t first = std::strtoull(argv[1], nullptr, 10);
    const std::uint64_t days = std::strtoull(argv[2], nullptr, 10);
    fmt::print(
        "{} days\nsensors  share    rms error, mGal  rms of u          error / u  share inside\n",
        days);
    for (const auto& [sensors, share] : kBoxes) show(first, days, sensors, share);
    return 0;
}
