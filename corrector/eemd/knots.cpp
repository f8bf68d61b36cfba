#include "corrector/eemd/knots.hpp"

#include <algorithm>

namespace a351::corrector::eemd {

AlternatingKnots::AlternatingKnots(std::size_t sample_count)
    : positions_(sample_count + 2 * kMostAdded + 8),
      values_(positions_.size()),
      segment_starts_(sample_count / 64 + 2) {}

void AlternatingKnots::take(std::size_t count, bool first_is_maximum) noexcept {
    extrema_count_ = count;
    first_is_maximum_ = first_is_maximum;
    begin_ = kMostAdded;
    end_ = kMostAdded + count;
}

void AlternatingKnots::add_ends(std::span<const double> curve, EndRule rule) noexcept {
    begin_ = kMostAdded;
    end_ = kMostAdded + extrema_count_;
    ends_at_last_sample_ = rule != EndRule::mirror || extrema_count_ < 3;
    if (!ends_at_last_sample_) {
        mirror_end(0.0, curve.front(), 1);
        mirror_end(static_cast<double>(curve.size() - 1), curve.back(), -1);
    } else {
        add_end_samples(curve);
    }
}

void AlternatingKnots::add_end_samples(std::span<const double> curve) noexcept {
    const double last = static_cast<double>(curve.size() - 1);
    // Two knots at either end, one for each envelope, so that the envelopes still alternate.
    const auto end_value = [&](std::size_t knot, double at, double sample, std::size_t nearest,
                               std::size_t next, bool has_two) {
        if (!has_two) return sample;
        const double slope =
            (values_[next] - values_[nearest]) / (positions_[next] - positions_[nearest]);
        const double line = values_[nearest] + (at - positions_[nearest]) * slope;
        return is_maximum(knot) ? std::max(sample, line) : std::min(sample, line);
    };
    for (const std::size_t distance : {1U, 2U}) {
        // An envelope has two extrema if the curve has three.  If its nearest extremum is the
        // second from the end, the curve must have four.
        const std::size_t left = kMostAdded - distance;
        const bool left_has_two = extrema_count_ + distance >= 5;
        positions_[left] = 0.0;
        values_[left] = end_value(left, 0.0, curve.front(), left + 2, left + 4, left_has_two);
        const std::size_t right = kMostAdded + extrema_count_ - 1 + distance;
        positions_[right] = last;
        values_[right] = end_value(right, last, curve.back(), right - 2, right - 4, left_has_two);
    }
    begin_ -= 2;
    end_ += 2;
}

void AlternatingKnots::mirror_end(double end, double sample, std::ptrdiff_t inwards) noexcept {
    const auto outermost =
        static_cast<std::ptrdiff_t>(inwards > 0 ? kMostAdded : kMostAdded + extrema_count_ - 1);
    const double* const x = positions_.data() + outermost;
    const double* const y = values_.data() + outermost;
    const bool within =
        is_maximum(static_cast<std::size_t>(outermost)) ? sample > y[inwards] : sample < y[inwards];
    const double reflected = 2.0 * x[0] - x[inwards];
    const bool about_extremum = within && (inwards > 0 ? reflected <= end : reflected >= end);
    const double centre = about_extremum ? x[0] : end;
    std::size_t added = 0;
    const auto add = [&](double position, double value) {
        const std::size_t knot = inwards > 0 ? --begin_ : end_++;
        positions_[knot] = position;
        values_[knot] = value;
        ++added;
    };
    if (!about_extremum) add(end, sample);
    for (std::size_t j = about_extremum ? 1 : 0; added < kMostAdded && j < extrema_count_; ++j) {
        const std::ptrdiff_t from = inwards * static_cast<std::ptrdiff_t>(j);
        add(2.0 * centre - x[from], y[from]);
    }
}

}  // namespace a351::corrector::eemd
