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
#include "sim/signal/slow_signal.hpp"

namespace a351::sim {

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

/// The samples of a simulated day, 50 a second on a fixed grid: sample k belongs to
/// scenario start + k/50 s and depends on (scenario, profile, seed, k) only.
///
/// The vertical specific force is turned into the axes by the levelling angles of the set-up,
/// then come axis biases, ground noise, bursts, spikes, white noise and rounding to counts.
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

    [[nodiscard]] const std::vector<PlannedOccupation>& plan() const noexcept { return plan_; }

private:
    void add_noise(std::array<double, 3>& axes_mgal);

    Scenario scenario_;
    const wire::DeviceProfile& profile_;
    std::vector<PlannedOccupation> plan_;
    SlowSignal slow_;
    Disturbances disturbances_;
    RandomStream white_, ground_, spikes_, temperature_;
    std::array<BandNoise, 3> ground_filter_;
    std::array<double, 3> bias_mgal_{};
    std::vector<std::array<double, 3>> vertical_;  ///< Unit vector per occupation.
    SlowValue from_, to_;
    std::int64_t sample_count_;
    std::int64_t index_ = 0;
};

}  // namespace a351::sim
