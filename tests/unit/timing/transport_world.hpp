#pragma once
/// @file
/// A sensor, its cable and its host in true time, with the observations of SampleClock and the
/// truth.

#include <algorithm>
#include <cmath>
#include <random>

#include "protocol/timing/sample_clock.hpp"

namespace a351::timing {

struct TransportCase {
    const char* name;
    double timer_ms;   ///< Latency timer of the adapter; 0: none.
    double timer_ppm;  ///< Rate error of its oscillator; relative to the sensor if in step.
    bool is_in_step;
    double delay_ms;          ///< Mean of the scheduler's exponential delay.
    double late_share;        ///< Share of frames that are up to 20 ms late.
    double pauses_per_h;      ///< Pauses of the host, of 1 to 5 s.
    double transient_ppm;     ///< Change of the sensor's rate from 30 min on, within 10 min.
    double walk_ppm_per_min;  ///< Random walk of the sensor's rate.
    double poll_ms = 1.0;     ///< Interval of the bus frames.
};

/// Transport of 50 samples/s. The sensor's rate is 12 ppm off, with a slow swing of 0.5 ppm over 4
/// h if it is free to move. The host's raw clock is 35 ppm off.
class TransportWorld {
public:
    static constexpr double kRawError = 35e-6;
    static constexpr int kRate = 50;

    TransportWorld(const TransportCase& parameters, std::uint64_t seed)
        : p_(parameters), random_(seed) {
        timer_phase_s_ = uniform_(random_) * 1e-3 * p_.timer_ms;
        poll_phase_s_ = uniform_(random_) * 1e-3 * p_.poll_ms;
        swing_phase_ = uniform_(random_) * 2.0 * kPi;
        plan_pause();
    }

    struct Frame {
        double taken_s, arrives_s;  ///< True time since the start.
    };

    Frame next() {
        if (k_ % kRate == 0) begin_second();
        const double taken = static_cast<double>(k_) / kRate + late_s_ -
                             1e-6 * ppm_ * static_cast<double>(k_ % kRate) / kRate;
        ++k_;
        double arrives = taken;
        if (p_.timer_ms > 0.0) {
            const double ppm = p_.timer_ppm + (p_.is_in_step ? kSensorPpm : 0.0);
            arrives = next_on(1e-3 * p_.timer_ms * (1.0 - 1e-6 * ppm), timer_phase_s_, arrives);
        }
        if (p_.poll_ms > 0.0) arrives = next_on(1e-3 * p_.poll_ms, poll_phase_s_, arrives);
        arrives += 1e-3 * p_.delay_ms * exponential_(random_);
        if (uniform_(random_) < p_.late_share) arrives += 20e-3 * uniform_(random_);
        arrives = last_s_ = std::max(last_s_, after_pause(arrives));
        return {taken, arrives};
    }

    [[nodiscard]] static RawTime raw(double true_s) {
        return RawTime(std::chrono::hours(1)) + from_seconds(true_s * (1.0 + kRawError));
    }

private:
    static constexpr double kPi = 3.14159265358979323846;
    static constexpr double kSensorPpm = 12.0;

    static double next_on(double period, double phase, double time) {
        return std::max(time, std::ceil((time - phase) / period) * period + phase);
    }

    void begin_second() {
        late_s_ -= 1e-6 * ppm_;
        const double t_s = static_cast<double>(k_ / kRate);
        walk_ppm_ += p_.walk_ppm_per_min / std::sqrt(60.0) * normal_(random_);
        const double swing =
            p_.is_in_step ? 0.0 : 0.5 * std::sin(2.0 * kPi * t_s / 14400.0 + swing_phase_);
        const double transient = t_s < 1800.0 ? 0.0 : 1.0 - std::exp(-(t_s - 1800.0) / 600.0);
        ppm_ = kSensorPpm + walk_ppm_ + swing + p_.transient_ppm * transient;
    }

    void plan_pause() {
        next_pause_s_ = pause_end_s_ + exponential_(random_) * 3600.0 / p_.pauses_per_h;
        pause_end_s_ = next_pause_s_ + 1.0 + 4.0 * uniform_(random_);
    }

    double after_pause(double time) {
        while (time >= pause_end_s_) plan_pause();
        return time >= next_pause_s_ ? pause_end_s_ : time;
    }

    TransportCase p_;
    std::mt19937_64 random_;
    std::uniform_real_distribution<double> uniform_{0.0, 1.0};
    std::exponential_distribution<double> exponential_{1.0};
    std::normal_distribution<double> normal_;
    std::int64_t k_ = 0;
    double ppm_ = 0.0, walk_ppm_ = 0.0, late_s_ = 0.0;
    double timer_phase_s_, poll_phase_s_, swing_phase_;
    double next_pause_s_ = 0.0, pause_end_s_ = 0.0, last_s_ = 0.0;
};

}  // namespace a351::timing
