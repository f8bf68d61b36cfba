#include "protocol/timing/hindsight.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/invariant.hpp"
#include "protocol/timing/host_clock_rules.hpp"

namespace a351::timing {
namespace {

using std::chrono::abs;

// Change of a host crystal's rate with temperature, relative: some tenths of a ppm per degC.
constexpr double kHostRateWander = 5e-6;

// Seconds of data from fit to fit: the length of a block of arrivals.
constexpr std::int64_t kFitEvery_s = 2;

constexpr Nanoseconds kSetBackWithin = std::chrono::seconds(60);

double ratio(Nanoseconds a, Nanoseconds b) {
    return static_cast<double>(a.count()) / static_cast<double>(b.count());
}

}  // namespace

void UtcHistory::notice_sleep(const ClockReading& reading) {
    if (last_) {
        const Nanoseconds asleep =
            (reading.boottime - last_->boottime) - (reading.raw - last_->raw);
        const Nanoseconds before = slept_.empty() ? Nanoseconds(0) : slept_.back();
        if (asleep > kShortestSleep) slept_.push_back(before + asleep);
    }
    last_ = reading;
}

RawTime UtcHistory::awake(RawTime raw, std::size_t sleeps) const {
    return sleeps == 0 ? raw : raw + slept_[sleeps - 1];
}

void UtcHistory::observe(const ClockReading& reading) {
    if (last_ && reading.raw <= last_->raw) return;
    notice_sleep(reading);
    const UtcTime midnight = announced_midnight(reading.realtime);
    if (reading.leap != LeapSecond::none && (leaps_.empty() || leaps_.back() != midnight))
        leaps_.push_back(midnight);
    if (is_synchronised_ && !reading.is_synchronised) return;
    if (reading.is_synchronised && !is_synchronised_) {
        pairs_.clear();
        is_synchronised_ = true;
    }
    const RawTime awake = this->awake(reading.raw, sleeps());
    Pair pair{awake, reading.realtime.time_since_epoch() - awake.time_since_epoch(),
              std::chrono::microseconds(reading.max_error_us), sleeps()};
    if (!is_synchronised_) pair.error = std::max(pair.error, kUnknownClockError);
    if (!pairs_.empty()) join(pair);
    pairs_.push_back(pair);
}

void UtcHistory::join(Pair& pair) {
    const auto follows = [&](const Pair& before) {
        return before.sleeps == pair.sleeps &&
               abs(pair.offset - before.offset) <=
                   kClockStep + most_slewed(pair.awake - before.awake);
    };
    pair.stretch = pairs_.back().stretch;
    if (follows(pairs_.back())) return;
    ++pair.stretch;
    const auto begin = std::ranges::find(pairs_, pairs_.back().stretch, &Pair::stretch);
    if (begin == pairs_.begin() || pair.awake - begin->awake >= kSetBackWithin) return;
    if (!follows(*std::prev(begin))) return;
    pair.stretch = std::prev(begin)->stretch;
    pairs_.erase(begin, pairs_.end());
}

// On the line through `pair` and the farther end of its stretch: over a longer line, a time service
// that is still slewing has less effect.
UtcHistory::Point UtcHistory::beyond(Pairs::const_iterator pair, RawTime awake,
                                     std::size_t sleeps) const {
    const auto [first, past] =
        std::equal_range(pairs_.begin(), pairs_.end(), *pair,
                         [](const Pair& a, const Pair& b) { return a.stretch < b.stretch; });
    const auto last = std::prev(past);
    const auto other = pair->awake - first->awake > last->awake - pair->awake ? first : last;
    double slope = 0.0, slope_error = kHostRateError;
    if (other != pair) {
        const Nanoseconds over = other->awake - pair->awake;
        slope = ratio(other->offset - pair->offset, over);
        slope_error = std::min(kHostRateWander + ratio(other->error + pair->error, abs(over)),
                               kHostRateError);
    }
    const double away_s = std::chrono::duration<double>(awake - pair->awake).count();
    const Nanoseconds asleep = sleeps == pair->sleeps ? Nanoseconds(0) : kUnknownClockError;
    return {UtcTime(awake.time_since_epoch() + pair->offset + from_seconds(slope * away_s)),
            pair->error + from_seconds(slope_error * std::abs(away_s)) + asleep, pair->stretch};
}

UtcHistory::Point UtcHistory::at(RawTime raw, std::size_t sleeps) const {
    Point point = between(raw, sleeps);
    for (const UtcTime leap : leaps_)
        if (abs(point.utc - leap) <= kLeapDoubt)
            point.error = std::max(point.error, kUnknownClockError);
    return point;
}

UtcHistory::Point UtcHistory::between(RawTime raw, std::size_t sleeps) const {
    const RawTime awake = this->awake(raw, sleeps);
    const auto after = std::ranges::upper_bound(pairs_, awake, {}, &Pair::awake);
    if (after == pairs_.begin()) return beyond(after, awake, sleeps);
    const auto before = std::prev(after);
    if (after == pairs_.end()) return beyond(before, awake, sleeps);
    if (after->stretch != before->stretch) {
        const bool is_woken = before->sleeps != sleeps && after->sleeps == sleeps;
        return beyond(is_woken ? after : before, awake, sleeps);
    }
    const Nanoseconds since = awake - before->awake, until = after->awake - awake;
    const double share = ratio(since, after->awake - before->awake);
    const double rise_s =
        std::chrono::duration<double>(after->offset - before->offset).count() * share;
    return {UtcTime(awake.time_since_epoch() + before->offset + from_seconds(rise_s)),
            std::max(before->error, after->error) + host_drift(std::min(since, until)),
            before->stretch};
}

Hindsight::Hindsight(SampleClockOptions options, std::size_t sleeps)
    : options_(options), period_(options.rate), sleeps_(sleeps) {}

void Hindsight::host_slept(std::size_t sleeps) {
    sleeps_ = sleeps;
    begins_stretch_ = true;
}

void Hindsight::observe(std::int64_t index, RawTime arrival) {
    require_invariant(stretches_.empty() || index > stretches_.back().last,
                      "the samples of a run have ascending indices");
    if (begins_stretch_ || period_.of(index - stretches_.back().last) > kLongestLoss)
        stretches_.push_back(
            {index, index, sleeps_, ArrivalEdge(options_.rate, ArrivalEdge::Memory::all)});
    begins_stretch_ = false;
    stretches_.back().edge.observe(index, arrival);
    stretches_.back().last = index;
}

std::vector<TimePiece> Hindsight::times(const UtcHistory& history) const {
    std::vector<TimePiece> pieces;
    const std::int64_t second = period_.per_second();
    for (const Stretch& stretch : stretches_) {
        EdgeLine line = stretch.edge.line_around(stretch.first);
        UtcHistory::Point point = history.at(line.arrival, stretch.sleeps);
        bool is_break = !pieces.empty();
        for (std::int64_t k = stretch.first; k <= stretch.last; k += second) {
            const bool is_fitted = (k - stretch.first) / second % kFitEvery_s != 0;
            require_invariant(pieces.empty() || pieces.back().first < k,
                              "each piece of the times begins after the one before");
            const EdgeLine next_line = is_fitted ? stretch.edge.line_around(k + second) : line;
            const UtcHistory::Point next =
                history.at(next_line.at(k + second, period_), stretch.sleeps);
            const bool jumps = next.stretch != point.stretch;
            const Nanoseconds nominal = period_.of(second);
            const Nanoseconds step =
                jumps ? nominal +
                            from_seconds(line.skew * std::chrono::duration<double>(nominal).count())
                      : next.utc - point.utc;
            pieces.push_back({k, point.utc - options_.fixed_delay, step,
                              line.uncertainty + point.error, is_break});
            is_break = jumps && abs(next.utc - (point.utc + step)) > kBreak;
            line = next_line;
            point = next;
        }
    }
    return pieces;
}

}  // namespace a351::timing
