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
        mirror_left_end(curve.front());
        mirror_right_end(curve.back(), static_cast<double>(curve.size() - 1));
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

void AlternatingKnots::mirror_left_end(double sample) noexcept {
    const double* const x = extrema_positions().data();
    const double* const y = extrema_values().data();
    const bool within = is_maximum(kMostAdded) ? sample > y[1] : sample < y[1];
    const bool about_extremum = within && 2.0 * x[0] - x[1] <= 0.0;
    const double centre = about_extremum ? x[0] : 0.0;
    if (!about_extremum) {
        positions_[--begin_] = 0.0;
        values_[begin_] = sample;
    }
    for (std::size_t j = about_extremum ? 1 : 0; begin_ > 0 && j < extrema_count_; ++j) {
        positions_[--begin_] = 2.0 * centre - x[j];
        values_[begin_] = y[j];
    }
}

void AlternatingKnots::mirror_right_end(double sample, double last_sample) noexcept {
    const std::size_t last = kMostAdded + extrema_count_ - 1;
    const double* const x = positions_.data() + last;
    const double* const y = values_.data() + last;
    const bool within = is_maximum(last) ? sample > y[-1] : sample < y[-1];
    const bool about_extremum = within && 2.0 * x[0] - x[-1] >= last_sample;
    const double centre = about_extremum ? x[0] : last_sample;
    if (!about_extremum) {
        positions_[end_] = last_sample;
        values_[end_++] = sample;
    }
    for (std::size_t j = about_extremum ? 1 : 0; end_ <= last + kMostAdded && j < extrema_count_;
         ++j) {
        positions_[end_] = 2.0 * centre - *(x - j);
        values_[end_++] = *(y - j);
    }
}

}  // namespace a351::corrector::eemd
