#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/wire/device_profile.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/disturbance.hpp"
#include "sim/signal/sample_source.hpp"
#include "sim/signal/sensor_clock.hpp"
#include "sim/signal/slow_signal.hpp"

namespace a351::sim::signal {

/// Returns the vertical in the sensor's axes, after the turn about y and then the turn about x.
[[nodiscard]] std::array<double, 3> tilted_vertical(const scenario::PlannedSetUp& set_up);

/// Returns the biases of x and y, which are fixed for a unit, and 0 for z, whose bias is a Term.
[[nodiscard]] std::array<double, 3> axis_bias_mgal(const scenario::Scenario& scenario,
                                                   std::uint64_t seed);

/// Returns the nearest count, limited to the range of 32 bits; the lowest count for NaN.
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

/// The samples of a simulated day, 50 a second by the sensor's clock.  Sample k depends on
/// (scenario, profile, seed, k) only.  With a true clock its instant is scenario start + k/50 s.
///
/// Gravity, tide and ripple act along the vertical; the levelling angles of the set-up distribute
/// them over the axes.  Bias, temperature error, slow noise and drift arise within the sensor; they
/// are added on axis z for any levelling, but for the share of the scale.  Then come the biases of x and y, ground noise, bursts,
/// spikes, white noise and rounding to counts.
class Source final : public SampleSource {
public:
    static constexpr int kRateHz = 50;

    Source(const scenario::Scenario& scenario, const wire::DeviceProfile& profile,
           std::uint64_t seed);
    Source(const Source&) = delete;  // Its members refer to its scenario and plan.
    Source& operator=(const Source&) = delete;

    [[nodiscard]] std::int64_t sample_count() const noexcept { return sample_count_; }
    [[nodiscard]] int rate_hz() const noexcept override { return kRateHz; }
    [[nodiscard]] std::optional<UtcTime> next_instant() const override;
    [[nodiscard]] TimedSample next() override;

    /// Returns the plant that makes the temperature; it is up to two seconds ahead of the samples.
    /// A setting made there changes the samples from then on; reading it changes nothing.
    [[nodiscard]] plant::OvenPlant& oven() noexcept { return slow_.oven(); }
    /// Returns that of the outer oven; null if the scenario has none.
    [[nodiscard]] plant::OvenPlant* outer_oven() noexcept { return slow_.outer_oven(); }

    [[nodiscard]] const std::vector<scenario::PlannedSetUp>& plan() const noexcept { return plan_; }

private:
    [[nodiscard]] double share_of_second() const noexcept;
    void add_noise(std::array<double, 3>& axes_mgal);

    scenario::Scenario scenario_;
    const wire::DeviceProfile& profile_;
    std::vector<scenario::PlannedSetUp> plan_;
    SlowSignal slow_;
    Disturbances disturbances_;
    noise::RandomStream white_, ground_, spikes_, temperature_;
    std::vector<BandNoise> ground_filter_;  ///< One per axis.
    std::array<double, 3> bias_mgal_{};
    std::vector<std::array<double, 3>> vertical_;  ///< One unit vector per set-up.
    SensorClock clock_;
    SlowValue from_, to_;
    std::int64_t sample_count_;
    std::int64_t index_ = 0;
};

}  // namespace a351::sim::signal
