#include "corrector/whole_day/lag_states.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/signal/moments.hpp"

namespace a351::corrector::whole_day {
namespace {

constexpr std::size_t kStep = 30;           // 60 s between stretches that are tried
constexpr double kLeastUnknown_degc = 0.1;  // an oven without any record may have moved as much

/// Returns e at the end of a stretch that is bridged by a straight line: the response of the lag to
/// the difference between temperature and line.
double state_error_degc(const std::vector<double>& degc, const reading::TemperatureGap& stretch,
                        double steps_of_lag) {
    const double keep = std::exp(-1.0 / steps_of_lag);
    const auto length = static_cast<double>(stretch.after - stretch.before);
    const double rise = (degc[stretch.after] - degc[stretch.before]) / length;
    double error = 0.0;
    for (std::size_t i = stretch.before + 1; i <= stretch.after; ++i) {
        const double line = degc[stretch.before] + rise * static_cast<double>(i - stretch.before);
        error = keep * error + (1.0 - keep) * (degc[i] - line);
    }
    return error;
}

/// Returns stretches as long as the gap that contain no gap.
std::vector<reading::TemperatureGap> stretches_like(const reading::TemperatureGap& gap,
                                                    const reading::DayTemperature& temperature) {
    const std::size_t length = gap.after - gap.before;
    std::vector<reading::TemperatureGap> found;
    for (std::size_t i = 0; i + length < temperature.series.size(); i += kStep)
        if (std::ranges::none_of(temperature.gaps, [&](const reading::TemperatureGap& other) {
                return other.before < i + length && i < other.after;
            }))
            found.push_back({i, i + length});
    return found;
}

}  // namespace

std::vector<LagStates> lag_states(const reading::DayTemperature& temperature, double fast_lag_s,
                                  double slow_lag_s) {
    const std::vector<double>& degc = temperature.series.values();
    const double rate_hz = temperature.series.rate().value();
    std::vector<LagStates> states;
    for (const reading::TemperatureGap& gap : temperature.gaps) {
        const auto stretches = stretches_like(gap, temperature);
        const auto deviation = [&](double lag_s) {
            if (stretches.empty())
                return std::max(std::sqrt(signal::variance_of(degc)), kLeastUnknown_degc);
            double squares = 0.0;
            for (const reading::TemperatureGap& stretch : stretches)
                squares += std::pow(state_error_degc(degc, stretch, lag_s * rate_hz), 2);
            return std::sqrt(squares / static_cast<double>(stretches.size()));
        };
        states.push_back({temperature.series.time_of(static_cast<double>(gap.after)),
                          deviation(fast_lag_s), deviation(slow_lag_s)});
    }
    return states;
}

double remaining(const reading::DayBin& bin, UtcTime from, double lag_s) {
    double sum = 0.0;
    for (const UtcTime time : bin.times)
        if (time >= from) sum += std::exp(-seconds_between(from, time) / lag_s);
    return sum / static_cast<double>(bin.times.size());
}

}  // namespace a351::corrector::whole_day
