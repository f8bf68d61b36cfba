#include "tests/support/wrong_sensor.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "daemon/believable/rate_watch.hpp"
#include "daemon/believable/watch.hpp"
#include "protocol/text/message.hpp"
#include "sim/noise/random.hpp"
#include "sim/signal/signal_source.hpp"

namespace a351::sim {
namespace {

using daemon::believable::temperature_formats;
using signal::SensorSample;

const TemperatureFormat& kSlope = temperature_formats()[0];
const TemperatureFormat& kShifted = temperature_formats()[1];
const TemperatureFormat& kQ10 = temperature_formats()[2];
constexpr double kAtOnce_s = 10.0, kFrozen_s = 620.0, kNextStart_s = 60.0, kDay_s = 86'400.0;

template <int numerator, int denominator>
SensorSample scaled(const SensorSample& now, const SensorSample&, double) {
    SensorSample sent = now;
    for (std::int32_t& counts : sent.axes_counts)
        counts = signal::to_counts(static_cast<double>(counts) * numerator / denominator);
    return sent;
}

SensorSample words_exchanged(const SensorSample& now, const SensorSample&, double) {
    SensorSample sent = now;
    for (std::int32_t& counts : sent.axes_counts)
        counts = std::bit_cast<std::int32_t>(std::rotl(std::bit_cast<std::uint32_t>(counts), 16));
    return sent;
}

SensorSample bytes_exchanged(const SensorSample& now, const SensorSample&, double) {
    SensorSample sent = now;
    for (std::int32_t& counts : sent.axes_counts) {
        const auto bits = std::bit_cast<std::uint32_t>(counts);
        counts = std::bit_cast<std::int32_t>((bits & 0x00FF'00FF) << 8 | (bits >> 8 & 0x00FF'00FF));
    }
    return sent;
}

SensorSample bytes_reversed(const SensorSample& now, const SensorSample& first, double) {
    return words_exchanged(bytes_exchanged(now, first, 0.0), first, 0.0);
}

SensorSample axes_held(const SensorSample& now, const SensorSample& first, double) {
    return {first.axes_counts, now.temperature_counts};
}

template <std::size_t axis>
SensorSample axis_zero(const SensorSample& now, const SensorSample&, double) {
    SensorSample sent = now;
    sent.axes_counts[axis] = 0;
    return sent;
}

template <std::size_t axis>
SensorSample axis_held(const SensorSample& now, const SensorSample& first, double) {
    SensorSample sent = now;
    sent.axes_counts[axis] = first.axes_counts[axis];
    return sent;
}

template <std::int32_t counts>
SensorSample temperature_register(const SensorSample& now, const SensorSample&, double) {
    return {now.axes_counts, counts};
}

SensorSample temperature_held(const SensorSample& now, const SensorSample& first, double) {
    return {now.axes_counts, first.temperature_counts};
}

SensorSample x_and_z_exchanged(const SensorSample& now, const SensorSample&, double) {
    return {{now.axes_counts[2], now.axes_counts[1], now.axes_counts[0]}, now.temperature_counts};
}

SensorSample z_turned_over(const SensorSample& now, const SensorSample&, double) {
    return {{now.axes_counts[0], now.axes_counts[1], -now.axes_counts[2]}, now.temperature_counts};
}

template <int sign>
SensorSample drifting(const SensorSample& now, const SensorSample&, double since_s) {
    SensorSample sent = now;
    for (std::int32_t& counts : sent.axes_counts)
        counts = signal::to_counts(counts * (1.0 + sign * 0.01 * since_s / kDay_s));
    return sent;
}

SensorSample as_sent(const SensorSample& now, const SensorSample&, double) { return now; }

SensorSample shifted(const SensorSample& now, const SensorSample&, double) {
    return {now.axes_counts, signal::to_counts(65536.0 * now.temperature_counts)};
}

SensorSample q10(const SensorSample& now, const SensorSample&, double) {
    const double degc = kSlope.slope_degc * now.temperature_counts + kSlope.offset_degc;
    return {now.axes_counts, signal::to_counts(std::floor(1024.0 * degc))};
}

constexpr const char *kScale = "the scale does not fit", *kDead = "it is dead",
                     *kConversion = "its conversion does not fit",
                     *kUnknown = "cannot be corrected for", *kOrder = "its bytes in another order",
                     *kRepeats = "the sensor repeats its values",
                     *kVertical = "the vertical axis is", *kUnstable = "is not stable";

const std::array kKinds{
    WrongSensor{"axes x 1/2", kAtOnce_s, kScale, scaled<1, 2>},
    WrongSensor{"axes x 2", kAtOnce_s, kScale, scaled<2, 1>},
    WrongSensor{"axes x 1/4", kAtOnce_s, kScale, scaled<1, 4>},
    WrongSensor{"axes x 4", kAtOnce_s, kScale, scaled<4, 1>},
    WrongSensor{"axes x 1/256", kAtOnce_s, kScale, scaled<1, 256>},
    WrongSensor{"axes in m/s2 / 10", kAtOnce_s, kScale, scaled<87, 100>},
    WrongSensor{"words of axes exchanged", kAtOnce_s, kOrder, words_exchanged},
    WrongSensor{"bytes of words exchanged", kAtOnce_s, kOrder, bytes_exchanged},
    WrongSensor{"bytes of axes reversed", kAtOnce_s, kOrder, bytes_reversed},
    WrongSensor{"x is zero", kAtOnce_s, kDead, axis_zero<0>},
    WrongSensor{"y is zero", kAtOnce_s, kDead, axis_zero<1>},
    WrongSensor{"z is zero", kAtOnce_s, kDead, axis_zero<2>},
    WrongSensor{"x keeps its value", kAtOnce_s, kDead, axis_held<0>},
    WrongSensor{"y keeps its value", kAtOnce_s, kDead, axis_held<1>},
    WrongSensor{"z keeps its value", kAtOnce_s, kDead, axis_held<2>},
    WrongSensor{"all axes keep their values", kAtOnce_s, kRepeats, axes_held},
    WrongSensor{"x and z exchanged", kNextStart_s, kVertical, x_and_z_exchanged, nullptr, nullptr,
                true},
    WrongSensor{"z turned over", kNextStart_s, kVertical, z_turned_over, nullptr, nullptr, true},
    WrongSensor{"scale + 1 % a day", kDay_s, kUnstable, drifting<1>},
    WrongSensor{"scale - 1 % a day", kDay_s, kUnstable, drifting<-1>},
    WrongSensor{"temperature keeps its value", kFrozen_s, kUnknown, temperature_held},
    WrongSensor{"temperature register 0", kFrozen_s, kUnknown, temperature_register<0>},
    WrongSensor{"temperature register -1", kFrozen_s, kUnknown, temperature_register<-1>},
    WrongSensor{"slope read as slope / 65536", kAtOnce_s, kConversion, as_sent, &kShifted, &kSlope},
    WrongSensor{"slope read as Q10", kAtOnce_s, kConversion, as_sent, &kQ10, &kSlope},
    WrongSensor{"counts x 65536 read as slope", kAtOnce_s, kConversion, shifted, &kSlope,
                &kShifted},
    WrongSensor{"counts x 65536 read as Q10", kAtOnce_s, kConversion, shifted, &kQ10, &kShifted},
    WrongSensor{"Q10 read as slope", kAtOnce_s, kConversion, q10, &kSlope, &kQ10},
    WrongSensor{"Q10 read as slope / 65536", kAtOnce_s, kConversion, q10, &kShifted, &kQ10},
};

}  // namespace

std::span<const WrongSensor> wrong_sensors() { return kKinds; }

std::optional<FirstTroubles> first_troubles(const WatchedRecord& record) {
    const wire::DeviceProfile& profile = *wire::find_profile("A351");
    wire::DeviceProfile assumed = profile;
    if (record.wrong && record.wrong->assumed) {
        assumed.temperature_slope_degc = record.wrong->assumed->slope_degc;
        assumed.temperature_offset_degc = record.wrong->assumed->offset_degc;
    }
    signal::Source source(record.scenario, profile, record.seed);
    if (record.switched_on_to) source.oven().set_set_point(*record.switched_on_to);
    daemon::believable::Watch watch(assumed, signal::Source::kRateHz);
    std::optional<SensorSample> first;
    bool is_history_over = false;
    while (const auto instant = source.next_instant()) {
        const double at_s = seconds_between(record.scenario.start(), *instant);
        if (record.length_s > 0.0 && at_s > record.length_s) break;
        const signal::TimedSample sample = source.next();
        SensorSample sent = sample.values;
        if (record.wrong && at_s >= record.wrong_from_s) {
            if (!first) first = sent;
            sent = record.wrong->send(sent, *first, at_s - record.wrong_from_s);
        }
        if (!is_history_over && at_s >= record.history_s) {
            watch.end_of_history();
            is_history_over = true;
        }
        watch.take(*instant, {sent.axes_counts[0], sent.axes_counts[1], sent.axes_counts[2],
                              sent.temperature_counts});
        if (sample.index % signal::Source::kRateHz != 0) continue;
        if (record.is_oven_heard)
            watch.take_oven(*instant, source.oven().controller_reading(),
                            source.oven().set_point());
        const auto troubles = watch.troubles();
        if (is_history_over && !troubles.empty())
            return FirstTroubles{at_s - record.wrong_from_s, text::in_english(troubles)};
    }
    return std::nullopt;
}

std::optional<double> rate_named_after_s(double error, std::uint64_t seed) {
    constexpr double kLength_s = 600.0, kTimer_s = 0.016, kMostStall_s = 0.4;
    noise::RandomStream stalls(seed, "stalls");
    daemon::believable::RateWatch watch(signal::Source::kRateHz);
    double stalled_until_s = 0.0;
    for (std::int64_t k = 0;; ++k) {
        const double at_s = static_cast<double>(k) / (signal::Source::kRateHz * (1.0 + error));
        if (at_s > kLength_s) return std::nullopt;
        if (stalls.uniform(0.0, 1.0) < 0.01)
            stalled_until_s = std::max(stalled_until_s, at_s + stalls.uniform(0.0, kMostStall_s));
        const double timer_s = kTimer_s * (std::floor(at_s / kTimer_s) + 1.0);
        watch.take(k, RawTime(from_seconds(std::max(timer_s, stalled_until_s))));
        if (watch.wrong_rate()) return at_s;
    }
}

}  // namespace a351::sim
