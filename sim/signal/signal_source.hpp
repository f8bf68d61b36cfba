#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/wire/device_profile.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/disturbance.hpp"
#include "sim/signal/sample_source.hpp"
#include "sim/signal/sensor_clock.hpp"
#include "sim/signal/slow_signal.hpp"

namespace a351::sim {

/// The vertical as the axes see it, after turning about y by one angle and then about x.
[[nodiscard]] std::array<double, 3> tilted_vertical(const PlannedSetUp& set_up);

/// Of x and y, fixed for a unit; that of z is a Term.
[[nodiscard]] std::array<double, 3> axis_bias_mgal(const Scenario& scenario, std::uint64_t seed);

/// The nearest count; at the ends of the range, which no count is beyond, and the lowest for NaN.
[[nodiscard]] std::int32_t to_counts(double counts) noexcept;

/// Noise between two frequencies: white noise through a first-order high-pass and low-pass.
class BandNoise {
public:
    BandNoise(double rms, double low_hz, double high_hz, double rate_hz);

    [[nodiscard]] double next(double white) noexcept;

private:
    [[nodiscard]] double filter(double x) noexcept;
    double low_gain_, high_gain_;
    double gain_ = 1.0;
    double slow_ = 0.0, fast_ = 0.0;
};

/// The samples of a simulated day, 50 a second by the sensor's clock: sample k depends on
/// (scenario, profile, seed, k) only, and with a true clock belongs to scenario start + k/50 s.
///
/// Gravity, tide and ripple are a force along the vertical, turned into the axes by the levelling
/// angles of the set-up.  The rest of what the vertical reads arises within the sensor - bias,
/// temperature error, slow noise, drift - and stays on axis z however the box stands.  Then come
/// the biases of x and y, ground noise, bursts, spikes, white noise and rounding to counts.
class SignalSource final : public SampleSource {
public:
    static constexpr int kRateHz = 50;

    SignalSource(const Scenario& scenario, const wire::DeviceProfile& profile, std::uint64_t seed);
    SignalSource(const SignalSource&) = delete;  // Its parts refer to its scenario and plan.
    SignalSource& operator=(const SignalSource&) = delete;

    [[nodiscard]] std::int64_t sample_count() const noexcept { return sample_count_; }
    [[nodiscard]] int rate_hz() const noexcept override { return kRateHz; }
    [[nodiscard]] std::optional<UtcTime> next_instant() const override;
    [[nodiscard]] TimedSample next() override;

    /// The plant behind the temperature, up to two seconds ahead of the samples.  What is set there
    /// changes the samples from then on; otherwise they do not depend on who looks.
    [[nodiscard]] OvenPlant& oven() noexcept { return slow_.oven(); }

    [[nodiscard]] const std::vector<PlannedSetUp>& plan() const noexcept { return plan_; }

private:
    [[nodiscard]] double share_of_second() const noexcept;
    void add_noise(std::array<double, 3>& axes_mgal);

    Scenario scenario_;
    const wire::DeviceProfile& profile_;
    std::vector<PlannedSetUp> plan_;
    SlowSignal slow_;
    Disturbances disturbances_;
    RandomStream white_, ground_, spikes_, temperature_;
    std::array<BandNoise, 3> ground_filter_;
    std::array<double, 3> bias_mgal_{};
    std::vector<std::array<double, 3>> vertical_;  ///< Unit vector per set-up.
    SensorClock clock_;
    SlowValue from_, to_;
    std::int64_t sample_count_;
    std::int64_t index_ = 0;
};

}  // namespace a351::sim
