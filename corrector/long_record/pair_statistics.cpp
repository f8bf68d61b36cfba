#include "corrector/long_record/pair_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/units.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::long_record {
namespace {

/// Returns the peak-to-peak value of a sine with this standard deviation: 2 sqrt(2) times it.
double swing(std::span<const double> values) {
    return 2.0 * std::sqrt(2.0 * signal::variance_of(values));
}

double zero_crossing_period_s(std::span<const double> values, double step_s) {
    std::size_t first = 0, last = 0, count = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        if (values[i - 1] >= 0.0 || values[i] < 0.0) continue;
        if (count++ == 0) first = i;
        last = i;
    }
    if (count < 2) return 0.0;
    return step_s * static_cast<double>(last - first) / static_cast<double>(count - 1);
}

text::Message seconds_late(double delay_s) {
    const std::string seconds = text::fixed(std::abs(delay_s), 0);
    return delay_s < 0.0 ? text::message("{} s before", seconds)
                         : text::message("{} s after", seconds);
}

}  // namespace

PairStatistics pair_statistics(std::span<const double> temperature_degc,
                               std::span<const double> acceleration_mgal, double step_s,
                               double cycle_s, double shift_s) {
    PairStatistics pair;
    pair.shift_s = shift_s;
    pair.period_s = zero_crossing_period_s(temperature_degc, step_s);
    pair.temperature_swing_degc = swing(temperature_degc);
    pair.acceleration_swing_mgal = swing(acceleration_mgal);
    std::vector<double> turned(acceleration_mgal.begin() + std::llround(shift_s / step_s),
                               acceleration_mgal.end());
    for (double& value : turned) value = -value;
    // In a narrow band residuals keep their phase for several cycles.
    const auto correlated = static_cast<std::size_t>(std::llround(4.0 * cycle_s / step_s));
    pair.moved = signal::fit_line(temperature_degc.first(turned.size()), turned, correlated);
    const int half_cycle = std::max(2, static_cast<int>(0.5 * cycle_s / step_s));
    // Half of the record still overlaps at the longest delay.
    const auto most = static_cast<int>(temperature_degc.size() / 2);
    const int hour = static_cast<int>(kSecondsPerHour / step_s);
    const int most_lag = std::max(half_cycle + 1, std::min(most, std::max(2 * half_cycle, hour)));
    pair.correlation =
        signal::correlate(temperature_degc, acceleration_mgal, half_cycle, most_lag, step_s);
    pair.chance = signal::chance_correlation(temperature_degc, acceleration_mgal,
                                             std::min(most, 16 * half_cycle));
    return pair;
}

double phase_of_peaks_deg(const PairStatistics& pair) {
    // A delayed sine lags by 360 delay / period; the negative peak has 180 degrees more.
    const auto lag_deg = [&](double delay_s) { return 360.0 * delay_s / pair.period_s; };
    const double by_positive = -lag_deg(pair.correlation.positive.delay_s) * kRadPerDeg;
    const double by_negative = (180.0 - lag_deg(pair.correlation.negative.delay_s)) * kRadPerDeg;
    // Mean direction of two angles: that of the sum of their vectors.
    return std::atan2(std::sin(by_positive) + std::sin(by_negative),
                      std::cos(by_positive) + std::cos(by_negative)) /
           kRadPerDeg;
}

double rate_coefficient(const PairStatistics& pair) {
    const signal::CorrelationPeak& negative = pair.correlation.negative;
    const double gain =
        std::abs(negative.value) * pair.acceleration_swing_mgal / pair.temperature_swing_degc;
    const double angular_hz = 2.0 * std::numbers::pi / pair.period_s;
    const double phase_rad = phase_of_peaks_deg(pair) * std::numbers::pi / 180.0;
    return gain * std::sin(phase_rad) / angular_hz / kSecondsPerHour;
}

text::Message causal_reading(const PairStatistics& pair) {
    const signal::CorrelationPeak &negative = pair.correlation.negative,
                                  &positive = pair.correlation.positive;
    const double ratio = std::abs(positive.value / negative.value);
    const double phase_deg = phase_of_peaks_deg(pair);
    constexpr double kEqual = 1.25;  // largest ratio of peaks of equal size
    constexpr double kWeak =
        0.3;  // least correlation of a response: it explains a tenth of the variance
    constexpr double kQuadrature_deg = 45.0;
    if (std::max(std::abs(negative.value), std::abs(positive.value)) < kWeak)
        return text::message(
            "Neither peak exceeds chance: in this band the record shows no response to "
            "temperature.");
    text::Message text = text::message(
        "The acceleration varies like the temperature with inverted sign {} it, and with the same "
        "sign {} it. ",
        seconds_late(negative.delay_s), seconds_late(positive.delay_s));
    if (ratio > kEqual || ratio < 1.0 / kEqual)
        text += text::message(
            "The peaks differ in size by {}: the band is not narrow, and the {} peak describes the "
            "response better. ",
            text::fixed(std::max(ratio, 1.0 / ratio), 2),
            text::marked_message(ratio > 1.0 ? text::marked("positive")
                                             : text::marked("negative")));
    else
        text += text::message(
            "The peaks have nearly equal size: in a narrow band both describe the same response, "
            "with a phase of {} degrees at {} s. ",
            text::fixed(phase_deg, 0), text::fixed(pair.period_s, 0));
    if (negative.delay_s < 0.0 || positive.delay_s < 0.0)
        text += text::message(
            "No effect comes before its cause: the early peak is not a delayed response of its "
            "sign. ");
    if (std::abs(std::abs(phase_deg) - 90.0) < kQuadrature_deg)
        text += text::message(
            "The response is mostly to the rate of change of the temperature, {} mGal per degC/h "
            "in this band: the crystals feel a change {}",
            text::fixed(rate_coefficient(pair), 1),
            phase_deg > 0.0 ? text::message("before the thermometer that compensates them does.")
                            : text::message("after the thermometer that compensates them."));
    else
        text += std::abs(phase_deg) > 90.0
                    ? text::message(
                          "The response is mostly to the temperature itself, with inverted sign.")
                    : text::message(
                          "The response is mostly to the temperature itself, with the same sign.");
    return text;
}

}  // namespace a351::corrector::long_record
