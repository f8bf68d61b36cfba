#include "sim/signal/disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/units.hpp"
#include "sim/noise/random.hpp"

namespace a351::sim::signal {
namespace {

double draw(noise::RandomStream& stream, scenario::Range range) {
    return stream.uniform(range.low, range.high);
}

/// Draws a burst: length and strength once; frequency, phase and share of the strength per axis.
Burst& draw_burst(std::vector<Burst>& bursts, noise::RandomStream& stream, Burst::Envelope envelope,
                  scenario::Range length_s, scenario::Range hz, scenario::Range peak_gal,
                  scenario::Range axis_share) {
    Burst& burst = bursts.emplace_back();
    burst.envelope = envelope;
    burst.length_s = draw(stream, length_s);
    const double peak_mgal = kMilliGalPerGal * draw(stream, peak_gal);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        burst.peak_mgal[axis] = peak_mgal * draw(stream, axis_share);
        burst.frequency_hz[axis] = draw(stream, hz);
        burst.phase_rad[axis] = stream.uniform(0.0, 2.0 * std::numbers::pi);
    }
    return burst;
}

double envelope_at(const Burst& burst, double u) {
    switch (burst.envelope) {
        case Burst::Envelope::swell: {
            const double s = std::sin(std::numbers::pi * u);
            return s * s;
        }
        case Burst::Envelope::decay:
            return (1.0 - u) * (1.0 - u) * (1.0 - u);
        case Burst::Envelope::growth:
            return u * u * u;
    }
    return 0.0;
}

}  // namespace

std::vector<Burst> draw_bursts(const scenario::Scenario& scenario,
                               const std::vector<scenario::PlannedSetUp>& plan,
                               std::uint64_t seed) {
    const scenario::VibrationParameters& p = scenario.vibration;
    const double record_s = seconds_between(scenario.start(), scenario.end());
    std::vector<Burst> bursts;

    const std::uint64_t box_seed = scenario.box_seed(seed);
    noise::RandomStream vehicles(box_seed, "vehicles");
    if (p.vehicles_per_h > 0.0) {
        const double mean_wait_s = 3600.0 / p.vehicles_per_h;
        double t = mean_wait_s * vehicles.exponential();
        while (t < record_s) {
            Burst& burst = draw_burst(bursts, vehicles, Burst::Envelope::swell, p.vehicle_s,
                                      p.vehicle_hz, p.vehicle_gal, p.axis_share);
            burst.start_s = t;
            t += mean_wait_s * vehicles.exponential();
        }
    }

    noise::RandomStream handling(box_seed, "handling");
    noise::RandomStream knocks(box_seed, "knocks");
    for (const scenario::PlannedSetUp& set_up : plan) {
        if (!set_up.is_occupied) continue;
        const double start_s = seconds_between(scenario.start(), set_up.start);
        const double end_s = seconds_between(scenario.start(), set_up.end);
        if (handling.uniform() < p.handling_probability) {
            Burst& burst = draw_burst(bursts, handling, Burst::Envelope::decay, p.handling_s,
                                      p.handling_hz, p.handling_gal, p.axis_share);
            burst.start_s = start_s;
        }
        if (handling.uniform() < p.handling_probability) {
            Burst& burst = draw_burst(bursts, handling, Burst::Envelope::growth, p.handling_s,
                                      p.handling_hz, p.handling_gal, p.axis_share);
            burst.start_s = end_s - burst.length_s;
        }
        if (knocks.uniform() < p.knock_probability / set_up.parts) {
            Burst& burst = draw_burst(bursts, knocks, Burst::Envelope::decay, p.knock_s, p.knock_hz,
                                      p.knock_gal, p.axis_share);
            burst.start_s = start_s + (end_s - start_s) * draw(knocks, p.knock_position);
        }
    }
    std::stable_sort(bursts.begin(), bursts.end(),
                     [](const Burst& a, const Burst& b) { return a.start_s < b.start_s; });
    return bursts;
}

Disturbances::Disturbances(std::vector<Burst> bursts) : bursts_(std::move(bursts)) {}

void Disturbances::add_to(std::array<double, 3>& axes_mgal, double elapsed_s) {
    while (next_ < bursts_.size() && bursts_[next_].start_s <= elapsed_s)
        active_.push_back(bursts_[next_++]);
    if (active_.empty()) return;
    std::erase_if(active_, [elapsed_s](const Burst& burst) {
        return elapsed_s >= burst.start_s + burst.length_s;
    });
    for (const Burst& burst : active_) {
        const double since_s = elapsed_s - burst.start_s;
        const double envelope = envelope_at(burst, since_s / burst.length_s);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            axes_mgal[axis] +=
                envelope * burst.peak_mgal[axis] *
                std::sin(2.0 * std::numbers::pi * burst.frequency_hz[axis] * since_s +
                         burst.phase_rad[axis]);
        }
    }
}

}  // namespace a351::sim::signal
