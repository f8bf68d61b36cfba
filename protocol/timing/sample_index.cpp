#include "protocol/timing/sample_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "protocol/core/invariant.hpp"

namespace a351::timing {
namespace {

constexpr std::int64_t kCounterRange = 65536;
constexpr double kAgreement_s = 1.0;  // a wrong choice is off by a period: 16 s or more

// Relative rate error: device 10 ppm (M-A352AD10 data sheet, electrical specifications) and a host
// crystal.
constexpr double kRateError = 100e-6;

// Largest step back, ticks (about a second), that counts as a corrupt counter.  A larger one counts
// as a jump ahead by almost the whole range of the counter.
constexpr std::int64_t kJumpBack = 4096;

// Delay that no adapter causes: such a frame was in a buffer.
constexpr Nanoseconds kLate = std::chrono::seconds(10);

// Long enough to include frames without delay, short enough for kRateError to be negligible.
constexpr double kWindow_s = 512.0;

double in_seconds(Nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

SampleIndex::SampleIndex(std::uint16_t count_step, Hertz rate)
    : count_step_(count_step),
      rate_hz_(rate.value()),
      period_(kCounterRange / std::gcd(std::int64_t{count_step}, kCounterRange)) {}

RawTime SampleIndex::start_of(std::int64_t index, RawTime arrival) const {
    return arrival - from_seconds(static_cast<double>(index) / rate_hz_);
}

Placement SampleIndex::place(std::uint16_t count, bool contiguous, RawTime arrival) {
    if (!last_index_) {
        last_index_ = -1;
        earliest_start_ = window_earliest_start_ = start_of(0, arrival);
        return accept(1, count, arrival);
    }
    const auto difference = static_cast<std::uint16_t>(count - last_count_);
    if (difference == count_step_) return accept(1, count, arrival);
    const bool is_whole = difference % count_step_ == 0;
    const std::int64_t by_counter = difference / count_step_;
    if (contiguous) {
        if (difference == 0) return {Placement::Kind::duplicate, 0, 0};
        const Nanoseconds late_by = start_of(*last_index_, last_arrival_) - earliest_start_;
        if (late_by > kLate)
            if (const auto advance = advance_by_time(difference, arrival))
                return accept(*advance, count, arrival);
        if (is_whole && difference <= kCounterRange - kJumpBack)
            return accept(by_counter, count, arrival);
        if (const auto advance = advance_by_time(difference, arrival))
            return accept(*advance, count, arrival);
        return refuse(count);
    }
    if (const auto advance = advance_by_time(difference, arrival))
        return accept(*advance, count, arrival);
    if (difference == 0) return {Placement::Kind::duplicate, 0, 0};
    if (is_whole && static_cast<double>(by_counter) <= kAgreement_s * rate_hz_)
        return accept(by_counter, count, arrival);
    return {Placement::Kind::new_session, 0, 0};
}

// Returns the advance > 0 that matches the counter and is nearest to elapsed time, if both agree.
std::optional<std::int64_t> SampleIndex::advance_by_time(std::uint16_t difference,
                                                         RawTime arrival) const {
    const std::int64_t divisor = kCounterRange / period_;
    if (difference % divisor != 0) return std::nullopt;
    std::int64_t counts = difference;
    while (counts % count_step_ != 0) counts += kCounterRange;
    const std::int64_t least = counts / count_step_;  // 0 ... period - 1

    const double predicted =
        in_seconds(arrival - earliest_start_) * rate_hz_ - static_cast<double>(*last_index_);
    const double periods =
        std::round((predicted - static_cast<double>(least)) / static_cast<double>(period_));
    const std::int64_t advance =
        least + period_ * std::max(static_cast<std::int64_t>(periods), std::int64_t{0});
    if (advance == 0) return std::nullopt;
    const double tolerance_s = kAgreement_s + kRateError * in_seconds(arrival - last_arrival_);
    const double error_s = std::abs(predicted - static_cast<double>(advance)) / rate_hz_;
    return error_s <= tolerance_s ? std::optional(advance) : std::nullopt;
}

Placement SampleIndex::accept(std::int64_t advance, std::uint16_t count, RawTime arrival) {
    require_invariant(advance > 0, "a sample has a larger index than the one before");
    const bool is_first = *last_index_ < 0;
    const std::int64_t index = *last_index_ + advance;
    last_index_ = index;
    last_count_ = count;
    last_arrival_ = arrival;
    anomalous_count_.reset();

    const RawTime start = start_of(index, arrival);
    if (static_cast<double>(index - window_first_) >= kWindow_s * rate_hz_) {
        earliest_start_ = window_earliest_start_;
        window_earliest_start_ = start;
        window_first_ = index;
    }
    window_earliest_start_ = std::min(window_earliest_start_, start);
    earliest_start_ = std::min(earliest_start_, window_earliest_start_);

    if (is_first) return {Placement::Kind::first, index, 0};
    if (advance == 1) return {Placement::Kind::next, index, 0};
    return {Placement::Kind::after_gap, index, advance - 1};
}

Placement SampleIndex::refuse(std::uint16_t count) {
    const bool continues =
        anomalous_count_ && static_cast<std::uint16_t>(count - *anomalous_count_) == count_step_;
    anomalous_count_ = count;
    return {continues ? Placement::Kind::new_session : Placement::Kind::anomaly, 0, 0};
}

}  // namespace a351::timing
