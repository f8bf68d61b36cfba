#include "sim/signal/signal_source.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace a351::sim::signal {

std::int32_t to_counts(double counts) noexcept {
    using Limits = std::numeric_limits<std::int32_t>;
    const double whole = std::floor(counts + 0.5);
    if (whole >= static_cast<double>(Limits::max())) return Limits::max();
    if (whole > static_cast<double>(Limits::min())) return static_cast<std::int32_t>(whole);
    return Limits::min();
}

std::array<double, 3> tilted_vertical(const scenario::PlannedSetUp& set_up) {
    const double y = set_up.about_y_rad, x = set_up.about_x_rad;
    return {std::sin(y), -std::cos(y) * std::sin(x), std::cos(y) * std::cos(x)};
}

std::array<double, 3> axis_bias_mgal(const scenario::Scenario& scenario, std::uint64_t seed) {
    noise::RandomStream stream(seed, "axis bias");
    const double most = scenario.sensor.horizontal_bias_max_mgal;
    const double x_mgal = stream.uniform(-most, most);
    return {x_mgal, stream.uniform(-most, most), 0.0};
}

BandNoise::BandNoise(double rms, double low_hz, double high_hz, double rate_hz)
    : low_gain_(1.0 - std::exp(-2.0 * std::numbers::pi * low_hz / rate_hz)),
      high_gain_(1.0 - std::exp(-2.0 * std::numbers::pi * high_hz / rate_hz)) {
    // The variance of filtered white noise is the energy of the impulse response.  The response is
    // negligible after 20 time constants of the high-pass.
    const int length = static_cast<int>(20.0 / low_gain_) + 1;
    double energy = 0.0;
    for (int i = 0; i < length; ++i) {
        const double y = filter(i == 0 ? 1.0 : 0.0);
        energy += y * y;
    }
    slow_ = fast_ = 0.0;
    gain_ = rms / std::sqrt(energy);
}

double BandNoise::filter(double x) noexcept {
    fast_ += high_gain_ * (x - fast_);
    slow_ += low_gain_ * (fast_ - slow_);
    return fast_ - slow_;
}

double BandNoise::next(double white) noexcept { return gain_ * filter(white); }

Source::Source(const scenario::Scenario& scenario, const wire::DeviceProfile& profile,
               std::uint64_t seed)
    : scenario_(scenario),
      profile_(profile),
      plan_(scenario::plan_survey(scenario_, seed)),
      slow_(scenario_, plan_, seed),
      disturbances_(draw_bursts(scenario_, plan_, seed)),
      white_(seed, "sensor white"),
      ground_(seed, "ground"),
      spikes_(seed, "spikes"),
      temperature_(seed, "temperature white"),
      ground_filter_(3, BandNoise(scenario.vibration.ground_mgal, scenario.vibration.ground_low_hz,
                                  scenario.vibration.ground_high_hz, kRateHz)),
      bias_mgal_(axis_bias_mgal(scenario_, seed)),
      clock_(scenario_.clock, DegC(scenario_.error.reference_degc), scenario_.start(), seed),
      sample_count_(static_cast<std::int64_t>(
          std::floor(seconds_between(scenario_.start(), scenario_.end()) * kRateHz))) {
    for (const scenario::PlannedSetUp& set_up : plan_) vertical_.push_back(tilted_vertical(set_up));
    from_ = slow_.next();
    to_ = slow_.next();
    clock_.begin_second(from_.temperature);
}

double Source::share_of_second() const noexcept {
    return static_cast<double>(index_ % kRateHz) / kRateHz;
}

std::optional<UtcTime> Source::next_instant() const {
    if (index_ == sample_count_) return std::nullopt;
    return clock_.at(share_of_second());
}

void Source::add_noise(std::array<double, 3>& axes_mgal) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        axes_mgal[axis] += bias_mgal_[axis] + ground_filter_[axis].next(ground_.normal()) +
                           scenario_.sensor.white_mgal * white_.normal();
    }
    if (spikes_.uniform() < scenario_.vibration.spike_probability) {
        const scenario::Range gal = scenario_.vibration.spike_gal;
        const std::size_t axis = spikes_.bits() % 3;
        const double sign = spikes_.uniform() < 0.5 ? -1.0 : 1.0;
        axes_mgal[axis] += sign * 1000.0 * spikes_.uniform(gal.low, gal.high);
    }
}

TimedSample Source::next() {
    assert(index_ < sample_count_);
    TimedSample sample{*next_instant(), index_, {}};
    const double share = share_of_second();
    const double vertical_mgal =
        from_.along_vertical.value() + share * (to_.along_vertical - from_.along_vertical).value();
    const double z_mgal = from_.along_z.value() + share * (to_.along_z - from_.along_z).value();
    std::array<double, 3> axes_mgal = vertical_[from_.set_up];
    for (double& axis : axes_mgal) axis *= vertical_mgal;
    axes_mgal[2] += z_mgal;
    disturbances_.add_to(axes_mgal, static_cast<double>(index_) / kRateHz);
    add_noise(axes_mgal);

    const double counts_per_mgal =
        std::ldexp(1.0, profile_.acceleration_fraction_bits) / kMilliGalPerStandardGravity;
    for (std::size_t axis = 0; axis < 3; ++axis)
        sample.values.axes_counts[axis] = to_counts(axes_mgal[axis] * counts_per_mgal);
    const double temperature_degc = from_.temperature.value() +
                                    share * (to_.temperature - from_.temperature).value() +
                                    scenario_.sensor.temperature_white_degc * temperature_.normal();
    sample.values.temperature_counts = profile_.temperature_counts(DegC(temperature_degc));
    if (++index_ % kRateHz == 0) {
        from_ = to_;
        to_ = slow_.next();
        clock_.begin_second(from_.temperature);
    }
    return sample;
}

}  // namespace a351::sim::signal
