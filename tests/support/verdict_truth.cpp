#include "tests/support/verdict_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/signal/decimator.hpp"
#include "sim/signal/disturbance.hpp"
#include "sim/signal/signal_source.hpp"
#include "sim/signal/slow_signal.hpp"

using namespace a351::sim::noise;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace a351::sim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr auto kLongestDrive = std::chrono::minutes(40);
constexpr int kSamplesPerLive = 100;  ///< 50 Hz to 2 s.

double temperature_error(const SlowValue& value) {
    double sum_mgal = 0.0;
    for (const Term term :
         {Term::crystal_static, Term::crystal_dynamic, Term::clock, Term::warm_up}) {
        sum_mgal += value.terms_mgal[static_cast<std::size_t>(term)];
    }
    return sum_mgal;
}

std::vector<double> error_course(const Scenario& scenario, const std::vector<PlannedSetUp>& plan,
                                 std::uint64_t seed, std::optional<DegC> switched_on_to) {
    SlowSignal slow(scenario, plan, seed);
    const auto seconds = static_cast<int>(seconds_between(scenario.start(), scenario.end()));
    std::vector<double> error_mgal;
    for (int second = 0; second < seconds; ++second) {
        // signal::Source reads two seconds ahead before its oven can be set.
        if (second == 2 && switched_on_to) slow.oven().set_set_point(*switched_on_to);
        error_mgal.push_back(temperature_error(slow.next()));
    }
    return error_mgal;
}

/// Returns the touches of the box; passing vehicles are not touches.
std::vector<Touch> touches_of(const Scenario& scenario, const std::vector<PlannedSetUp>& plan,
                              std::uint64_t seed) {
    std::vector<Touch> touches;
    for (const Burst& burst : draw_bursts(scenario, plan, seed)) {
        if (burst.envelope == Burst::Envelope::swell) continue;
        touches.push_back({burst.start_s, burst.start_s + burst.length_s});
    }
    for (const PlannedSetUp& set_up : plan) {
        const double brought_s = seconds_between(scenario.start(), set_up.from);
        if (brought_s > 0.0) touches.push_back({brought_s, brought_s});
    }
    return touches;
}

/// Returns the raw samples decimated as in the daemon.
std::vector<daemon::verdict::LiveSample> live_series(const Scenario& scenario, std::uint64_t seed,
                                                     std::optional<DegC> switched_on_to) {
    const wire::DeviceProfile& profile = *wire::find_profile("A351");
    const double mgal_per_count =
        kMilliGalPerStandardGravity / std::ldexp(1.0, profile.acceleration_fraction_bits);
    signal::Source source(scenario, profile, seed);
    if (switched_on_to) source.oven().set_set_point(*switched_on_to);

    const auto filter = a351::signal::design_decimation(10);
    std::array<a351::signal::Decimator, 4> decimators{
        a351::signal::Decimator(filter, 2), a351::signal::Decimator(filter, 2),
        a351::signal::Decimator(filter, 2), a351::signal::Decimator(filter, 2)};
    std::array<std::vector<double>, 4> thinned, block;
    std::vector<daemon::verdict::LiveSample> samples;
    while (source.next_instant()) {
        for (auto& values : block) values.clear();
        for (int i = 0; i < kSamplesPerLive && source.next_instant(); ++i) {
            const SensorSample sample = source.next().values;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block[axis].push_back(mgal_per_count * sample.axes_counts[axis]);
            }
            block[3].push_back(profile.temperature_offset_degc +
                               profile.temperature_slope_degc * sample.temperature_counts);
        }
        double shake_mgal = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto [low, high] = std::minmax_element(block[axis].begin(), block[axis].end());
            shake_mgal = std::max(shake_mgal, 0.5 * (*high - *low));
        }
        for (std::size_t i = 0; i < block.size(); ++i) decimators[i].push(block[i], thinned[i]);
        if (thinned[0].empty()) continue;
        const std::size_t k = samples.size();
        if (k >= thinned[0].size()) continue;
        daemon::verdict::LiveSample live;
        live.time = scenario.start() + from_seconds(2.0 * static_cast<double>(k));
        const std::size_t raw = 100 * (k + 5);  // The filters reach 451 samples beyond the middle.
        live.seen_at = scenario.start() + from_seconds(static_cast<double>(raw) / 50.0);
        for (std::size_t axis = 0; axis < 3; ++axis) live.axes[axis] = MilliGal(thinned[axis][k]);
        live.temperature = DegC(thinned[3][k]);
        live.shake = MilliGal(shake_mgal);
        samples.push_back(live);
    }
    return samples;
}

/// Returns the scenario that the cases share, with occupations centred at these times.
Scenario visits(std::vector<double> centres_min, const std::vector<std::string>& sites) {
    Scenario scenario = load_scenario("tsukuba");
    const UtcTime zero = scenario.occupations.front().centre;
    scenario.occupations.clear();
    scenario.ambient.clear();
    scenario.open_lids.clear();
    for (std::size_t i = 0; i < centres_min.size(); ++i) {
        ListedOccupation listed;
        listed.site = sites[i % sites.size()];
        listed.number = static_cast<int>(i / sites.size()) + 1;
        listed.centre = zero + from_seconds(60.0 * centres_min[i]);
        scenario.occupations.push_back(listed);
    }
    return scenario;
}

/// Gives each occupation another ambient temperature; it changes during the drives between them.
void place_ambient(Scenario& scenario, RandomStream& draws, double most_degc) {
    double degc = draws.uniform(20.0, 32.0);
    const auto knot = [&](UtcTime utc) {
        ListedAmbient listed;
        listed.utc = utc;
        listed.degc = degc;
        scenario.ambient.push_back(listed);
    };
    const Nanoseconds half = from_seconds(0.5 * scenario.schedule.length_s);
    knot(scenario.occupations.front().centre - half - kLongestDrive);
    for (const ListedOccupation& listed : scenario.occupations) {
        degc += draws.uniform(-most_degc, most_degc);
        knot(listed.centre - half);
        knot(listed.centre + half);
    }
}

/// Sets the truth to unknown during drives and at the end of each occupation, where it would depend
/// on the drive that follows, which no verdict can foresee.
void leave_out_drives(VerdictRecord& record) {
    std::vector<bool> is_judged(record.truth.size());
    for (const PlannedSetUp& first : record.plan) {
        if (first.part != 1) continue;
        const PlannedSetUp& last = (&first)[first.parts - 1];
        const auto from = static_cast<std::size_t>(seconds_between(record.start, first.start));
        const auto to = static_cast<std::size_t>(seconds_between(record.start, last.end)) -
                        kAheadSeconds - kCycleSeconds / 2;
        std::fill(is_judged.begin() + static_cast<std::ptrdiff_t>(from),
                  is_judged.begin() + static_cast<std::ptrdiff_t>(to), true);
    }
    for (std::size_t i = 0; i < is_judged.size(); ++i) {
        if (!is_judged[i]) record.truth[i] = Allowed::unknown;
    }
}

}  // namespace

std::vector<double> cycle_mean(std::span<const double> error_mgal) {
    std::vector<double> mean(error_mgal.size(), kNan);
    std::vector<double> sum(error_mgal.size() + 1, 0.0);
    for (std::size_t i = 0; i < error_mgal.size(); ++i) sum[i + 1] = sum[i] + error_mgal[i];
    constexpr std::size_t kHalf = kCycleSeconds / 2;
    for (std::size_t i = kHalf; i + kHalf < error_mgal.size(); ++i) {
        mean[i] = (sum[i + kHalf] - sum[i - kHalf]) / kCycleSeconds;
    }
    return mean;
}

std::vector<Allowed> allowed(std::span<const double> mean_mgal, std::span<const Touch> touches) {
    std::vector<Allowed> truth(mean_mgal.size(), Allowed::unknown);
    for (std::size_t i = 0; i + kAheadSeconds < mean_mgal.size(); ++i) {
        if (std::isnan(mean_mgal[i]) || std::isnan(mean_mgal[i + kAheadSeconds])) continue;
        truth[i] = Allowed::yes;
        for (std::size_t s = 1; s <= kAheadSeconds; ++s) {
            if (std::abs(mean_mgal[i + s] - mean_mgal[i]) >= kMostChangeMgal) {
                truth[i] = Allowed::no;
                break;
            }
        }
    }
    for (const Touch& touch : touches) {
        const auto end = static_cast<std::size_t>(std::ceil(touch.to_s + kQuietSeconds));
        for (auto i = static_cast<std::size_t>(touch.from_s); i < std::min(end, truth.size());
             ++i) {
            if (truth[i] == Allowed::yes) truth[i] = Allowed::no;
        }
    }
    return truth;
}

VerdictRecord verdict_record(const Scenario& scenario, std::uint64_t seed,
                             std::optional<DegC> switched_on_to) {
    VerdictRecord record;
    record.start = scenario.start();
    record.plan = plan_survey(scenario, seed);
    record.mean_mgal = cycle_mean(error_course(scenario, record.plan, seed, switched_on_to));
    record.touches = touches_of(scenario, record.plan, seed);
    record.truth = allowed(record.mean_mgal, record.touches);
    record.samples = live_series(scenario, seed, switched_on_to);
    return record;
}

VerdictCase verdict_case(std::uint64_t seed) { return static_cast<VerdictCase>(seed % 3); }

VerdictRecord simulated_case(std::uint64_t seed) {
    RandomStream draws(seed, "verdict case");
    if (verdict_case(seed) == VerdictCase::warm_up) {
        Scenario scenario = load_scenario("indoor");
        scenario.fixed_record->duration_h = 5.0;
        scenario.ambient.clear();
        const double air_degc = draws.uniform(20.0, 32.0);
        for (const double hours : {0.0, 5.0}) {
            ListedAmbient knot;
            knot.hours = hours;
            knot.degc = air_degc + (hours > 0.0 ? draws.uniform(-3.0, 3.0) : 0.0);
            scenario.ambient.push_back(knot);
        }
        scenario.vibration.vehicles_per_h = 10.0;
        scenario.sensor.power_on_before_start_h = 0.0;
        scenario.oven.run_in_h = 0.0;
        scenario.oven.set_point_degc = draws.uniform(air_degc + 2.0, 41.5);
        return verdict_record(scenario, seed, DegC(42.5));
    }
    if (verdict_case(seed) == VerdictCase::visit) {
        constexpr double kStayMinutes = 35.0;
        const double second_min = kStayMinutes + draws.uniform(15.0, 40.0);
        const double third_min = second_min + kStayMinutes + draws.uniform(15.0, 40.0);
        Scenario scenario = visits({0.0, second_min, third_min}, {"No.0", "No.1", "No.2"});
        scenario.schedule.length_s = 60.0 * kStayMinutes;
        scenario.schedule.jitter_s = 0.0;
        scenario.schedule.lead_in_h = 2.0;
        scenario.schedule.set_ups = draws.uniform() < 0.5 ? 1 : 2;
        scenario.sensor.power_on_before_start_h = draws.uniform(3.0, 20.0);
        place_ambient(scenario, draws, 5.0);
        if (draws.uniform() < 0.3) {
            ListedOpenLid lid;
            lid.site = "No.1";
            lid.outside_degc = draws.uniform(18.0, 36.0);
            scenario.open_lids.push_back(lid);
        }
        VerdictRecord record = verdict_record(scenario, seed);
        leave_out_drives(record);
        return record;
    }
    Scenario scenario = visits({0.0, 20.0, 40.0, 60.0}, {"No.0"});
    scenario.schedule.lead_in_h = 1.0;
    scenario.vibration.knock_probability = 0.7;
    scenario.vibration.vehicles_per_h = draws.uniform(0.0, 60.0);
    scenario.vibration.ground_mgal = draws.uniform() < 0.5 ? 20.0 : 300.0;
    scenario.sensor.power_on_before_start_h = 12.0;
    place_ambient(scenario, draws, 0.5);
    return verdict_record(scenario, seed);
}

}  // namespace a351::sim
