#include "daemon/identify/received.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>

#include "protocol/wire/burst_decoder.hpp"

namespace a351::daemon::identify {
namespace {

Received::Axis axis_of(const std::vector<wire::BurstValues>& frames, std::size_t i) {
    Received::Axis axis;
    const auto count = static_cast<double>(frames.size());
    for (const auto& frame : frames) axis.mean_counts += frame.axes[i] / count;
    double deviations = 0.0, differences = 0.0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        deviations += std::pow(frames[k].axes[i] - axis.mean_counts, 2);
        if (k == 0) continue;
        differences += std::pow(double(frames[k].axes[i]) - double(frames[k - 1].axes[i]), 2);
        axis.is_constant &= frames[k].axes[i] == frames[0].axes[i];
    }
    axis.deviation_counts = std::sqrt(deviations / count);
    axis.noise_counts = std::sqrt(differences / count) / std::numbers::sqrt2;
    return axis;
}

/// Returns the slope of the straight line through points, by least squares: a late arrival counts
/// little.  Precondition: two different x.
double slope_of(const std::vector<double>& x, const std::vector<double>& y) {
    const auto count = static_cast<double>(x.size());
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count;
    const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / count;
    double squares = 0.0, products = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        squares += (x[i] - mean_x) * (x[i] - mean_x);
        products += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return products / squares;
}

/// Adds step and rate.
/// @param arrivals_s  of the frames.
void add_rate(const std::vector<double>& arrivals_s, Received& found) {
    std::map<std::uint16_t, std::size_t> steps;
    std::vector<double> ticks{0.0};
    for (std::size_t k = 1; k < found.frames.size(); ++k) {
        const auto step =
            static_cast<std::uint16_t>(found.frames[k].count - found.frames[k - 1].count);
        ++steps[step];
        ticks.push_back(ticks.back() + step);
    }
    if (steps.empty()) return;
    found.count_step =
        std::ranges::max_element(steps, {}, [](const auto& step) { return step.second; })->first;
    if (found.count_step == 0) return;
    const double s_per_tick = slope_of(ticks, arrivals_s);
    if (s_per_tick > 0.0) found.rate_hz = 1.0 / (s_per_tick * found.count_step);
}

}  // namespace

Received received(const Observation& seen, wire::BurstLayout layout) {
    Received found;
    std::vector<double> arrivals_s;
    wire::BurstDecoder decoder(layout, 1);  // the step is what is to be found
    std::span<const std::byte> input(seen.bytes);
    std::size_t position = 0;
    auto read = seen.reads.begin();
    while (const auto event = decoder.next(input)) {
        if (const auto* frame = std::get_if<wire::BurstFrame>(&*event)) {
            position += layout.frame_size();
            while (read->end < position) ++read;
            found.frames.push_back(frame->values());
            arrivals_s.push_back(
                std::chrono::duration<double>(read->time - seen.reads.front().time).count());
        } else {
            const std::size_t count = std::get<wire::Discarded>(*event).byte_count;
            position += count;
            found.skipped += count;
        }
    }
    if (found.frames.empty()) return found;
    for (std::size_t i = 0; i < found.axes.size(); ++i) found.axes[i] = axis_of(found.frames, i);
    add_rate(arrivals_s, found);
    return found;
}

}  // namespace a351::daemon::identify
