#include "corrector/eemd/extrema.hpp"

#include <algorithm>

namespace a351::corrector {
namespace {

/// Calls visit(first, last) for every interior extremum, a plateau being first..last.
template <class Visit>
void visit_extrema(std::span<const double> curve, Visit visit) {
    int direction = 0;
    std::size_t level_begin = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
        const int step = (curve[i] > curve[i - 1]) - (curve[i] < curve[i - 1]);
        if (step == 0) continue;
        if (step * direction < 0) visit(level_begin, i - 1);
        direction = step;
        level_begin = i;
    }
}

/// Value at `position` of the line through (x1, y1) and (x2, y2).
double line_at(double position, double x1, double y1, double x2, double y2) {
    return y1 + (position - x1) * ((y2 - y1) / (x2 - x1));
}

}  // namespace

EnvelopeKnots::EnvelopeKnots(std::size_t sample_count)
    // Half the samples at most, two ends, and the slot that find_extrema() writes ahead.
    : positions_(sample_count / 2 + 4), values_(sample_count / 2 + 4) {}

void find_extrema(std::span<const double> curve, EnvelopeKnots& maxima,
                  EnvelopeKnots& minima) noexcept {
    // Every step writes both candidates and keeps one by counting: noise would make branches here
    // the slowest part of a sift.
    double* const max_position = maxima.positions_.data() + 1;
    double* const max_value = maxima.values_.data() + 1;
    double* const min_position = minima.positions_.data() + 1;
    double* const min_value = minima.values_.data() + 1;
    std::size_t max_count = 0;
    std::size_t min_count = 0;
    bool was_rising = false;
    bool was_falling = false;
    std::size_t level_begin = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
        const double before = curve[i - 1];
        const bool rises = curve[i] > before;
        const bool falls = curve[i] < before;
        const double middle = 0.5 * static_cast<double>(level_begin + i - 1);
        max_position[max_count] = middle;
        max_value[max_count] = before;
        min_position[min_count] = middle;
        min_value[min_count] = before;
        max_count += static_cast<std::size_t>(was_rising & falls);
        min_count += static_cast<std::size_t>(was_falling & rises);
        const bool moves = rises | falls;
        level_begin = moves ? i : level_begin;
        was_rising = moves ? rises : was_rising;
        was_falling = moves ? falls : was_falling;
    }
    maxima.extrema_count_ = max_count;
    minima.extrema_count_ = min_count;
}

void add_end_knots(std::span<const double> curve, EnvelopeKnots& maxima,
                   EnvelopeKnots& minima) noexcept {
    const double end = static_cast<double>(curve.size() - 1);
    const auto add = [&](EnvelopeKnots& knots, auto outermost) {
        double* const x = knots.positions_.data();
        double* const y = knots.values_.data();
        const std::size_t n = knots.extrema_count_;
        x[0] = 0.0;
        y[0] = curve.front();
        x[n + 1] = end;
        y[n + 1] = curve.back();
        if (n < 2) return;
        y[0] = outermost(y[0], line_at(0.0, x[1], y[1], x[2], y[2]));
        y[n + 1] = outermost(y[n + 1], line_at(end, x[n], y[n], x[n - 1], y[n - 1]));
    };
    add(maxima, [](double a, double b) { return std::max(a, b); });
    add(minima, [](double a, double b) { return std::min(a, b); });
}

std::size_t count_extrema(std::span<const double> curve) noexcept {
    std::size_t count = 0;
    visit_extrema(curve, [&](std::size_t, std::size_t) { ++count; });
    return count;
}

std::vector<std::size_t> extremum_indices(std::span<const double> curve) {
    std::vector<std::size_t> indices;
    visit_extrema(
        curve, [&](std::size_t first, std::size_t last) { indices.push_back((first + last) / 2); });
    return indices;
}

}  // namespace a351::corrector
