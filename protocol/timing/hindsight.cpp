#include "protocol/timing/hindsight.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/timing/host_clock_rules.hpp"

namespace a351::timing {
namespace {

using std::chrono::abs;
using std::chrono::milliseconds;

constexpr Nanoseconds kBreak = milliseconds(5);

// A host's crystal at another temperature: some tenths of a ppm per degC.
constexpr double kHostRateWander = 5e-6;

double ratio(Nanoseconds a, Nanoseconds b) {
    return static_cast<double>(a.count()) / static_cast<double>(b.count());
}

}  // namespace

void UtcHistory::observe(const ClockReading& reading) {
    if (is_synchronised_ && !reading.is_synchronised) return;
    if (reading.is_synchronised && !is_synchronised_) {
        pairs_.clear();
        is_synchronised_ = true;
    }
    Pair pair;
    pair.raw = reading.raw;
    pair.offset = reading.realtime.time_since_epoch() - reading.raw.time_since_epoch();
    pair.asleep = reading.boottime - reading.raw.time_since_epoch();
    pair.error = std::chrono::microseconds(reading.max_error_us);
    if (!is_synchronised_) pair.error = std::max(pair.error, kUnknownClockError);
    if (!pairs_.empty()) {
        const Pair& last = pairs_.back();
        if (pair.raw <= last.raw) return;
        const bool has_slept = pair.asleep - last.asleep > kShortestSleep;
        const bool is_step =
            abs(pair.offset - last.offset) > kClockStep + most_slewed(pair.raw - last.raw);
        pair.stretch = last.stretch + (has_slept || is_step ? 1 : 0);
    }
    pairs_.push_back(pair);
}

// On the line through `pair` and the farther end of its stretch: the longer, the less a time service
// that is still slewing counts.
UtcHistory::Point UtcHistory::beyond(std::vector<Pair>::const_iterator pair, RawTime raw) const {
    const auto [first, past] =
        std::equal_range(pairs_.begin(), pairs_.end(), *pair,
                         [](const Pair& a, const Pair& b) { return a.stretch < b.stretch; });
    const auto last = std::prev(past);
    const auto other = pair->raw - first->raw > last->raw - pair->raw ? first : last;
    double slope = 0.0, slope_error = kHostRateError;
    if (other != pair) {
        const Nanoseconds over = other->raw - pair->raw;
        slope = ratio(other->offset - pair->offset, over);
        slope_error = std::min(kHostRateWander + ratio(other->error + pair->error, abs(over)),
                               kHostRateError);
    }
    const double away_s = std::chrono::duration<double>(raw - pair->raw).count();
    return {UtcTime(raw.time_since_epoch() + pair->offset + from_seconds(slope * away_s)),
            pair->error + from_seconds(slope_error * std::abs(away_s)), pair->stretch};
}

UtcHistory::Point UtcHistory::at(RawTime raw) const {
    const auto after = std::upper_bound(pairs_.begin(), pairs_.end(), raw,
                                        [](RawTime t, const Pair& pair) { return t < pair.raw; });
    if (after == pairs_.begin()) return beyond(after, raw);
    const auto before = std::prev(after);
    if (after == pairs_.end() || after->stretch != before->stretch) return beyond(before, raw);
    const Nanoseconds since = raw - before->raw, until = after->raw - raw;
    const double share = ratio(since, after->raw - before->raw);
    const double rise_s =
        std::chrono::duration<double>(after->offset - before->offset).count() * share;
    return {UtcTime(raw.time_since_epoch() + before->offset + from_seconds(rise_s)),
            std::max(before->error, after->error) + host_drift(std::min(since, until)),
            before->stretch};
}

Hindsight::Hindsight(SampleClockOptions options) : options_(options), period_(options.rate) {}

void Hindsight::host_slept() { begins_stretch_ = true; }

void Hindsight::observe(std::int64_t index, RawTime arrival) {
    if (begins_stretch_)
        stretches_.push_back({index, ArrivalEdge(options_.rate, ArrivalEdge::Memory::all)});
    begins_stretch_ = false;
    stretches_.back().edge.observe(index, arrival);
    last_ = index;
}

std::vector<TimePiece> Hindsight::times(const UtcHistory& history) const {
    std::vector<TimePiece> pieces;
    const std::int64_t second = period_.per_second();
    for (auto stretch = stretches_.begin(); stretch != stretches_.end(); ++stretch) {
        const std::int64_t end =
            std::next(stretch) == stretches_.end() ? last_ + 1 : std::next(stretch)->first;
        EdgeLine line = stretch->edge.line_around(stretch->first);
        UtcHistory::Point point = history.at(line.arrival);
        bool is_break = !pieces.empty();
        for (std::int64_t k = stretch->first; k < end; k += second) {
            const EdgeLine next_line = stretch->edge.line_around(k + second);
            const UtcHistory::Point next = history.at(next_line.arrival);
            const bool jumps = next.stretch != point.stretch;
            const Nanoseconds nominal = period_.of(second);
            const Nanoseconds step =
                jumps ? nominal + from_seconds(line.excess_rate *
                                               std::chrono::duration<double>(nominal).count())
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
