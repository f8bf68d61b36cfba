#include "sim/device/long_term_filter.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace a351::sim {

LongTermFilter::MovingAverage::MovingAverage(int log2_taps)
    : newest_(std::size_t{1} << log2_taps), log2_taps_(log2_taps) {}

std::int32_t LongTermFilter::MovingAverage::next(std::int32_t value) {
    sum_ += std::int64_t{value} - newest_[oldest_];
    newest_[oldest_] = value;
    oldest_ = (oldest_ + 1) % newest_.size();
    return static_cast<std::int32_t>(sum_ >> log2_taps_);
}

void LongTermFilter::start(Kind kind, int log2_taps) {
    assert(log2_taps >= 1 && log2_taps <= 12);
    kind_ = kind;
    averages_.clear();
    if (kind == Kind::off) return;
    averages_.assign(kind == Kind::low_pass ? 6 : 3, MovingAverage(log2_taps));
}

std::array<std::int32_t, 3> LongTermFilter::next(const std::array<std::int32_t, 3>& axes_counts) {
    std::array<std::int32_t, 3> filtered = axes_counts;
    if (kind_ == Kind::off) return filtered;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t average = averages_[axis].next(axes_counts[axis]);
        if (kind_ == Kind::low_pass) {
            filtered[axis] = averages_[3 + axis].next(average);
        } else {
            using Limits = std::numeric_limits<std::int32_t>;
            filtered[axis] = static_cast<std::int32_t>(std::clamp<std::int64_t>(
                std::int64_t{axes_counts[axis]} - average, Limits::min(), Limits::max()));
        }
    }
    return filtered;
}

}  // namespace a351::sim
