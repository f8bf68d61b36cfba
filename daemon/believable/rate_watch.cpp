#include "daemon/believable/rate_watch.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/believable/limits.hpp"
#include "daemon/believable/remedy.hpp"

namespace a351::daemon::believable {
namespace {

constexpr double kBlock_s = 8.0;
constexpr std::size_t kBlocks = 7;

double raw_seconds(RawTime from, RawTime to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void RateWatch::take(std::int64_t index, RawTime arrival) {
    if (first_ && raw_seconds(last_, arrival) > kBlock_s) *this = RateWatch(rate_hz_);
    if (!first_) {
        first_ = {index, arrival};
        block_begin_ = arrival;
    }
    last_ = arrival;
    if (raw_seconds(block_begin_, arrival) >= kBlock_s) {
        block_begin_ += from_seconds(kBlock_s);
        lags_s_.push_back(*least_lag_s_);
        if (lags_s_.size() > kBlocks) lags_s_.pop_front();
        least_lag_s_.reset();
    }
    const double lag_s =
        raw_seconds(first_->time, arrival) - static_cast<double>(index - first_->index) / rate_hz_;
    least_lag_s_ = std::min(lag_s, least_lag_s_.value_or(lag_s));
}

std::optional<Hertz> RateWatch::wrong_rate() const {
    if (lags_s_.size() < kBlocks) return std::nullopt;
    constexpr double kSpan_s = (kBlocks - 1) * kBlock_s;
    const double gained = (lags_s_.back() - lags_s_.front()) / kSpan_s;
    if (std::abs(gained) <= kMostRateError) return std::nullopt;
    for (std::size_t i = 1; i < kBlocks; ++i) {
        const double of_block = (lags_s_[i] - lags_s_[i - 1]) / kBlock_s;
        if (of_block / gained < 0.5) return std::nullopt;
    }
    return Hertz(rate_hz_ * (1.0 - gained));
}

text::Message rate_trouble(Hertz wrong_rate, int output_rate_hz) {
    return text::message(
               "the sensor sends {:.1f} samples/s, but output_rate_hz is {}: the sensor does not "
               "run at the rate that was set",
               wrong_rate.value(), output_rate_hz) +
           identify();
}

}  // namespace a351::daemon::believable
