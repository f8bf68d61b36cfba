#include "corrector/reading/interval_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "protocol/signal/moments.hpp"

namespace a351::corrector::reading {
namespace {

constexpr double kShapeBlockSeconds = 60.0;
constexpr double kMonotoneShare = 0.8;

std::vector<double> block_means(std::span<const double> values, std::size_t block_size) {
    std::vector<double> means;
    for (std::size_t i = 0; i + block_size <= values.size(); i += block_size)
        means.push_back(signal::mean_of(values.subspan(i, block_size)));
    return means;
}

/// Returns how many times `values` turn back by at least `threshold` from an extremum.
int turn_count(const std::vector<double>& values, double threshold) {
    int turns = 0;
    int direction = 0;  // unknown until the first move by the threshold
    double low = values.front();
    double high = values.front();
    for (const double value : values) {
        low = std::min(low, value);
        high = std::max(high, value);
        const bool rises = value - low >= threshold && direction <= 0;
        const bool falls = high - value >= threshold && direction >= 0;
        if (!rises && !falls) continue;
        if (direction != 0) ++turns;
        direction = rises ? 1 : -1;
        low = high = value;
    }
    return turns;
}

TemperatureShape shape_of(std::span<const double> temperatures, std::size_t block_size) {
    std::vector<double> means = block_means(temperatures, std::max<std::size_t>(block_size, 1));
    if (means.size() < 3) means.assign(temperatures.begin(), temperatures.end());
    const auto [low, high] = std::minmax_element(means.begin(), means.end());
    const double change = std::abs(means.back() - means.front());
    if (change >= kMonotoneShare * (*high - *low)) return TemperatureShape::monotone;
    return turn_count(means, (1.0 - kMonotoneShare) * (*high - *low)) <= 1
               ? TemperatureShape::half_wave
               : TemperatureShape::turning;
}

}  // namespace

std::optional<double> block_standard_error(std::span<const double> values, std::size_t block_size) {
    if (block_size == 0) return std::nullopt;
    const std::vector<double> means = block_means(values, block_size);
    if (means.size() < 2) return std::nullopt;
    const double centre = signal::mean_of(means);
    double squares = 0.0;
    for (const double value : means) squares += (value - centre) * (value - centre);
    const double count = static_cast<double>(means.size());
    return std::sqrt(squares / (count - 1.0) / count);
}

std::optional<TemperatureSummary> summarise_temperature(const TimeSeries<DegC>& temperature,
                                                        std::size_t first, std::size_t last) {
    std::vector<double> valid_degc;
    std::vector<double> hours;
    for (std::size_t i = first; i <= last && i < temperature.size(); ++i) {
        const double value = temperature.values()[i];
        if (std::isnan(value)) continue;
        valid_degc.push_back(value);
        hours.push_back(static_cast<double>(i) / temperature.rate().value() / kSecondsPerHour);
    }
    if (valid_degc.size() < 2) return std::nullopt;
    const double mean_degc = signal::mean_of(valid_degc);
    const double mean_hour = signal::mean_of(hours);
    double product = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < hours.size(); ++i) {
        product += (hours[i] - mean_hour) * (valid_degc[i] - mean_degc);
        square += (hours[i] - mean_hour) * (hours[i] - mean_hour);
    }
    const auto [low, high] = std::minmax_element(valid_degc.begin(), valid_degc.end());
    TemperatureSummary summary;
    summary.mean = DegC(mean_degc);
    summary.slope_degc_per_h = product / square;
    summary.range = DegC(*high - *low);
    summary.shape = shape_of(
        valid_degc,
        static_cast<std::size_t>(std::lround(kShapeBlockSeconds * temperature.rate().value())));
    return summary;
}

AxisSummary summarise_axis(const TimeSeries<StandardGravity>& raw,
                           const TimeSeries<StandardGravity>& trend, std::size_t ratio,
                           std::size_t first, std::size_t last) {
    const std::vector<double>& levels = trend.values();
    std::vector<double> samples;
    double squares = 0.0;
    for (std::size_t i = first * ratio; i <= last * ratio && i < raw.size(); ++i) {
        const std::size_t k = i / ratio;
        const double share = static_cast<double>(i % ratio) / static_cast<double>(ratio);
        const double next = k < last ? levels[k + 1] : levels[k];
        const double deviation = raw.values()[i] - (levels[k] + share * (next - levels[k]));
        if (std::isnan(deviation)) continue;
        samples.push_back(raw.values()[i]);
        squares += deviation * deviation;
    }
    const double rms = std::sqrt(squares / static_cast<double>(samples.size()));
    return {StandardGravity(signal::mean_of(samples)), to_milligal(StandardGravity(rms))};
}

}  // namespace a351::corrector::reading
