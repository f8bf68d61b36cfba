#include "protocol/timing/sample_clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/core/invariant.hpp"
#include "protocol/timing/host_clock_rules.hpp"

namespace a351::timing {
namespace {

using std::chrono::abs;
using std::chrono::milliseconds;

constexpr Nanoseconds kLargestPull = std::chrono::microseconds(200);  // per second of data
constexpr Nanoseconds kUnlocked = std::chrono::seconds(60);           // data before any other state
constexpr double kWorstRate_ppm = 1e6 * RateLimits::kLargest;         // known without a measurement
// The line follows RateLimits::kLargest at most.  A rate that is nearly as far off is that of a line
// that cannot follow.
constexpr double kFarthestRate_ppm = 100.0;
constexpr Nanoseconds kLocked = milliseconds(3);                // uncertainty of a locked line
constexpr Nanoseconds kRemembered = std::chrono::hours(24);     // data whose times are kept
constexpr Nanoseconds kShortestSpan = std::chrono::minutes(1);  // for a measured rate

}  // namespace

SampleClock::SampleClock(SampleClockOptions options)
    : options_(options), period_(options.rate), edge_(options.rate) {}

void SampleClock::observe_clock(const ClockReading& reading) {
    if (reading_ && reading.raw <= reading_->raw) return;
    if (reading_) {
        const Nanoseconds asleep =
            (reading.boottime - reading_->boottime) - (reading.raw - reading_->raw);
        if (asleep > kShortestSleep) {
            slept_ += asleep;
            edge_.restart();
            mapping_.woke_up();
            may_jump_ = true;
        }
    }
    reading_ = reading;
    ClockReading awake_reading = reading;
    awake_reading.raw = awake(reading.raw);
    if (mapping_.observe(awake_reading)) may_jump_ = true;
    if (last_ && !is_given_) fix_until(*last_);
}

void SampleClock::observe(std::int64_t index, RawTime arrival) {
    if (!first_) {
        first_ = index;
        fixed_until_ = index - index % period_.per_second();
    }
    require_invariant(!last_ || index > *last_, "the samples of a run have ascending indices");
    const bool is_far = last_ && period_.of(index - *last_) > kLongestLoss;
    last_ = index;
    if (is_given_) {
        const TimePiece& piece = piece_of(index);
        if (piece.is_break) last_break_ = piece.first;
        return;
    }
    if (is_far) may_jump_ = true;
    // First arrival after a sleep or a long loss: no sample in between gets a time.
    if (edge_.is_empty() || is_far) fixed_until_ = std::max(fixed_until_, index);
    edge_.observe(index, awake(arrival));
    fix_until(index);
}

void SampleClock::restart_index() {
    edge_.restart();
    line_.reset();
    first_.reset();
    last_.reset();
    pieces_.clear();
    last_break_.reset();
    may_jump_ = false;
    is_given_ = false;
}

void SampleClock::use(const std::vector<TimePiece>& times, bool is_host_synchronised) {
    pieces_.assign(times.begin(), times.end());
    is_given_ = !pieces_.empty();
    is_given_synchronised_ = is_host_synchronised;
}

void SampleClock::fix_until(std::int64_t index) {
    if (edge_.is_empty() || (line_ && index < fixed_until_)) return;
    line_ = edge_.line();
    if (mapping_.is_empty() || !edge_.is_settled()) return;
    while (fixed_until_ <= index) fix_second();
    while (pieces_.size() > 1 && period_.of(fixed_until_ - pieces_[1].first) > kRemembered)
        pieces_.pop_front();
}

void SampleClock::fix_second() {
    const std::int64_t next = fixed_until_ + period_.per_second();
    const UtcTime aim = target(fixed_until_);
    const bool is_first = pieces_.empty();
    UtcTime from = is_first ? aim : on(pieces_.back(), fixed_until_);
    const bool is_break = std::exchange(may_jump_, false) && abs(aim - from) > kBreak;
    if (is_break) {
        from = aim;
        last_break_ = fixed_until_;
    }
    const Nanoseconds step =
        target(next) - aim + std::clamp(aim - from, -kLargestPull, kLargestPull);
    require_invariant(is_first || pieces_.back().first < fixed_until_,
                      "each piece of the times begins after the one before");
    if (is_first || is_break || step != pieces_.back().step) {
        const Nanoseconds uncertainty =
            line_->uncertainty + abs(aim - from) + mapping_.error_at(line_at(fixed_until_));
        pieces_.push_back({fixed_until_, from, step, uncertainty, is_break});
    }
    fixed_until_ = next;
}

RawTime SampleClock::line_at(std::int64_t index) const { return line_->at(index, period_); }

UtcTime SampleClock::target(std::int64_t index) const {
    return mapping_.at(line_at(index)) - options_.fixed_delay;
}

UtcTime SampleClock::on(const TimePiece& piece, std::int64_t index) const {
    const std::int64_t samples = index - piece.first;
    return piece.time + samples / period_.per_second() * piece.step +
           samples % period_.per_second() * piece.step / period_.per_second();
}

// The first piece also holds for samples before it.
const TimePiece& SampleClock::piece_of(std::int64_t index) const {
    return *std::prev(
        std::ranges::upper_bound(pieces_.begin() + 1, pieces_.end(), index, {}, &TimePiece::first));
}

UtcTime SampleClock::published(std::int64_t index) const {
    if (pieces_.empty()) return target(index);
    if (is_given_) return on(piece_of(index), index);
    if (index < pieces_.front().first)
        return pieces_.front().time - period_.of(pieces_.front().first - index);
    if (index >= fixed_until_)
        return on(pieces_.back(), fixed_until_) + period_.of(index - fixed_until_);
    return on(piece_of(index), index);
}

std::optional<SampleTime> SampleClock::time_of(std::int64_t index) const {
    if (is_given_) {
        const Nanoseconds uncertainty = piece_of(index).uncertainty;
        return SampleTime{published(index), uncertainty,
                          uncertainty <= kLocked ? State::locked : State::coarse,
                          is_given_synchronised_};
    }
    if (!line_ || mapping_.is_empty()) return std::nullopt;
    const UtcTime utc = published(index);
    const auto age = abs(period_.of(index - line_->index));
    const Nanoseconds uncertainty =
        line_->uncertainty +
        from_seconds(line_->skew_uncertainty * std::chrono::duration<double>(age).count()) +
        abs(utc - target(index)) + mapping_.error_at(line_at(index));
    return SampleTime{utc, uncertainty, state(), mapping_.is_synchronised()};
}

std::optional<std::int64_t> SampleClock::index_at(UtcTime utc) const {
    if (pieces_.empty() || !first_) return std::nullopt;
    const std::int64_t oldest = std::max(*first_, pieces_.front().first);
    if (utc < published(oldest) || utc > published(*last_)) return std::nullopt;
    std::int64_t low = oldest;
    std::int64_t high = *last_;
    while (low < high) {
        const std::int64_t middle = low + (high - low) / 2;
        if (published(middle) < utc)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

State SampleClock::state() const noexcept {
    if (!last_ || period_.of(*last_ - *first_) < kUnlocked) return State::unlocked;
    if (mapping_.is_held()) return State::holdover;
    return line_ && line_->uncertainty <= kLocked ? State::locked : State::coarse;
}

std::optional<MeasuredRate> SampleClock::measured_rate() const {
    const auto newest = last_ && !is_given_ ? time_of(*last_) : std::nullopt;
    if (!newest) return std::nullopt;
    std::optional<MeasuredRate> best;
    for (const TimePiece& piece : pieces_) {
        const Nanoseconds span = newest->utc - piece.time;
        if (piece.first < last_break_.value_or(0) || span < kShortestSpan) continue;
        const double ppm = 1e6 *
                           static_cast<double>((piece.uncertainty + newest->uncertainty).count()) /
                           static_cast<double>(span.count());
        if (best && best->uncertainty_ppm <= ppm) continue;
        const double span_s = std::chrono::duration<double>(span).count();
        best = {Hertz(static_cast<double>(*last_ - piece.first) / span_s), ppm, span};
    }
    if (!best || best->uncertainty_ppm > kWorstRate_ppm) return std::nullopt;
    const double departure_ppm = 1e6 * (best->rate.value() / options_.rate.value() - 1.0);
    return std::abs(departure_ppm) <= kFarthestRate_ppm ? best : std::nullopt;
}

Nanoseconds SampleClock::uncertainty() const {
    const auto time = last_ ? time_of(*last_) : std::nullopt;
    return time ? time->uncertainty : Nanoseconds(0);
}

Nanoseconds SampleClock::host_uncertainty() const {
    const bool is_known = last_ && !is_given_ && line_ && !mapping_.is_empty();
    return is_known ? mapping_.error_at(line_at(*last_)) : Nanoseconds(0);
}

}  // namespace a351::timing
