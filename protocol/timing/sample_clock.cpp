#include "protocol/timing/sample_clock.hpp"

#include <algorithm>
#include <cmath>

namespace a351::timing {
namespace {

// Device 10 ppm (M-A352AD10 data sheet, electrical specifications) + host crystal 100 ppm, twice
// what PC crystals are usually specified to.
constexpr std::int64_t kRateError_ppm = 110;
constexpr std::int64_t kHostRateError_ppm = 100;

constexpr Nanoseconds kUnknownLatency = std::chrono::milliseconds(16);
constexpr Nanoseconds kUnsynchronisedError = std::chrono::seconds(1);
constexpr Nanoseconds kLargestPull = std::chrono::microseconds(200);  // per second of data
constexpr Nanoseconds kUnlocked = std::chrono::seconds(60);
constexpr Nanoseconds kRemembered = std::chrono::hours(24);

Nanoseconds ppm(Nanoseconds duration, std::int64_t parts) { return duration / 1'000'000 * parts; }

}  // namespace

SampleClock::SampleClock(SampleClockOptions options)
    : options_(options),
      samples_per_step_(std::max<std::int64_t>(1, std::llround(options.rate.value()))),
      nominal_step_(from_seconds(static_cast<double>(samples_per_step_) / options.rate.value())) {}

// In whole steps and a rest, so that no rounding grows with the index.
Nanoseconds SampleClock::duration(std::int64_t samples) const {
    return samples / samples_per_step_ * nominal_step_ +
           samples % samples_per_step_ * nominal_step_ / samples_per_step_;
}

void SampleClock::observe_clock(const ClockReading& reading) {
    reading_ = reading;
    if (start_) fix_until(last_);
}

void SampleClock::observe(std::int64_t index, RawTime arrival) {
    const RawTime start = arrival - duration(index);
    if (!start_) {
        first_ = index;
        fixed_until_ = index - index % samples_per_step_;
    }
    if (!start_ || start <= *start_ + ppm(duration(index - touched_), kRateError_ppm)) {
        start_ = start;
        touched_ = index;
    }
    last_ = index;
    if (index >= fixed_until_ && reading_) fix_until(index);
}

RawTime SampleClock::line(std::int64_t index) const {
    const Nanoseconds loosened =
        ppm(duration(std::max<std::int64_t>(0, last_ - touched_)), kRateError_ppm);
    return *start_ + loosened + duration(index);
}

UtcTime SampleClock::target(std::int64_t index) const {
    return reading_->realtime + (line(index) - reading_->raw) - options_.fixed_delay;
}

UtcTime SampleClock::on(const Piece& piece, std::int64_t index) const {
    const std::int64_t samples = index - piece.first;
    return piece.time + samples / samples_per_step_ * piece.step +
           samples % samples_per_step_ * piece.step / samples_per_step_;
}

void SampleClock::fix_until(std::int64_t index) {
    while (fixed_until_ <= index) {
        const std::int64_t next = fixed_until_ + samples_per_step_;
        const UtcTime from =
            pieces_.empty() ? target(fixed_until_) : on(pieces_.back(), fixed_until_);
        const Nanoseconds lag = target(next) - (from + nominal_step_);
        const Nanoseconds step = nominal_step_ + std::clamp(lag, -kLargestPull, kLargestPull);
        if (pieces_.empty() || step != pieces_.back().step)
            pieces_.push_back({fixed_until_, from, step});
        fixed_until_ = next;
    }
    while (pieces_.size() > 1 && duration(fixed_until_ - pieces_[1].first) > kRemembered)
        pieces_.pop_front();
}

UtcTime SampleClock::published(std::int64_t index) const {
    if (index < pieces_.front().first)
        return pieces_.front().time - duration(pieces_.front().first - index);
    if (index >= fixed_until_)
        return on(pieces_.back(), fixed_until_) + duration(index - fixed_until_);
    const auto after =
        std::upper_bound(pieces_.begin(), pieces_.end(), index,
                         [](std::int64_t i, const Piece& piece) { return i < piece.first; });
    return on(*std::prev(after), index);
}

std::optional<SampleTime> SampleClock::time_of(std::int64_t index) const {
    if (pieces_.empty()) return std::nullopt;
    const UtcTime utc = published(index);
    const RawTime raw = line(index);
    const Nanoseconds host{reading_->max_error_us * 1000};
    const Nanoseconds uncertainty =
        kUnknownLatency + 2 * ppm(duration(last_ - touched_), kRateError_ppm) +
        ppm(std::chrono::abs(duration(index - last_)), kRateError_ppm) +
        ppm(std::chrono::abs(raw - reading_->raw), kHostRateError_ppm) +
        (reading_->is_synchronised ? host : std::max(host, kUnsynchronisedError)) +
        std::chrono::abs(utc - target(index));
    return SampleTime{utc, uncertainty, state()};
}

std::optional<std::int64_t> SampleClock::index_at(UtcTime utc) const {
    if (pieces_.empty()) return std::nullopt;
    const std::int64_t oldest = std::max(first_, pieces_.front().first);
    if (utc < published(oldest) || utc > published(last_)) return std::nullopt;
    std::int64_t low = oldest;
    std::int64_t high = last_;
    while (low < high) {
        const std::int64_t middle = low + (high - low) / 2;
        if (published(middle) < utc)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

TimingState SampleClock::state() const noexcept {
    return start_ && duration(last_ - first_) >= kUnlocked ? TimingState::coarse
                                                           : TimingState::unlocked;
}

Nanoseconds SampleClock::uncertainty() const {
    const auto time = time_of(last_);
    return time ? time->uncertainty : Nanoseconds(0);
}

}  // namespace a351::timing
