#include "protocol/signal/moved_box.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace a351::signal {
namespace {

constexpr double kShaken_mgal = 2000.0;         // a hand gives 5 Gal or more
constexpr std::size_t kHandled = 3;             // samples: 5 s
constexpr std::size_t kReach = 5;               // samples: 10 s
constexpr std::size_t kCompared = 10;           // samples: 20 s, the ripple of 50 s is below 1 mGal
constexpr double kMoved_deg = 0.02;             // beyond what soft ground gives way in 20 s
constexpr double kHandledAndMoved_deg = 0.005;  // a placement is levelled to 0.1 deg
constexpr double kHandledAndMoved_mgal = 10.0;
constexpr std::size_t kCarried = 30;      // samples: a minute; handling takes up to 25 s
constexpr std::size_t kLeastStay = 90;    // samples: three minutes
constexpr std::size_t kWayToCar = 300;    // samples: ten minutes
constexpr std::chrono::minutes kLift(2);  // lifting, turning and levelling again
constexpr double kSamePlace_mgal = 5.0;   // three standard deviations of two placements

bool is_shaken(const MotionSample& sample) { return sample.shake.value() > kShaken_mgal; }

/// Returns true for the samples at rest, without NaN.
std::vector<bool> at_rest(std::span<const MotionSample> samples) {
    std::vector<bool> rest(samples.size());
    std::size_t clean = kReach;  // samples since the last shaken one
    for (std::size_t i = 0; i < samples.size(); ++i) {
        clean = is_shaken(samples[i]) ? 0 : clean + 1;
        double sum = 0.0;
        for (const MilliGal axis : samples[i].axes) sum += axis.value();
        rest[i] = clean > kReach && std::isfinite(sum);
    }
    clean = kReach;
    for (std::size_t i = samples.size(); i-- > 0;) {
        clean = is_shaken(samples[i]) ? 0 : clean + 1;
        if (clean <= kReach) rest[i] = false;
    }
    return rest;
}

struct Level {
    std::array<double, 3> axes_mgal{};
    double norm_mgal = 0.0;
};

Level mean_of(std::span<const MotionSample> samples, std::span<const std::size_t> places) {
    Level mean;
    const auto n = static_cast<double>(places.size());
    for (const std::size_t i : places) {
        const auto& axes = samples[i].axes;
        for (std::size_t k = 0; k < axes.size(); ++k) mean.axes_mgal[k] += axes[k].value() / n;
        mean.norm_mgal += std::hypot(axes[0].value(), axes[1].value(), axes[2].value()) / n;
    }
    return mean;
}

/// Returns the number of shaken samples in [from, to).
std::size_t shaken_in(std::span<const MotionSample> samples, std::size_t from, std::size_t to) {
    return static_cast<std::size_t>(
        std::ranges::count_if(samples.subspan(from, to - from), is_shaken));
}

}  // namespace

std::vector<BoxMove> find_box_moves(std::span<const MotionSample> samples) {
    const std::vector<bool> rest = at_rest(samples);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (rest[i]) places.push_back(i);
    std::vector<BoxMove> moves;
    const std::span<const std::size_t> all(places);
    std::size_t best = 0;      // place of the largest change of the move that is looked at
    double best_change = 0.0;  // in units of its threshold
    BoxMove found;
    for (std::size_t k = kCompared; k + kCompared <= places.size(); ++k) {
        const Level before = mean_of(samples, all.subspan(k - kCompared, kCompared)),
                    after = mean_of(samples, all.subspan(k, kCompared));
        double square = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            square += std::pow(after.axes_mgal[axis] - before.axes_mgal[axis], 2);
        const double tilt_deg = std::sqrt(square) / kMilliGalPerStandardGravity / kRadPerDeg;
        const double norm_mgal = after.norm_mgal - before.norm_mgal;
        double change = tilt_deg / kMoved_deg;
        if (shaken_in(samples, places[k - 1], places[k]) >= kHandled)
            change = std::max({change, tilt_deg / kHandledAndMoved_deg,
                               std::abs(norm_mgal) / kHandledAndMoved_mgal});
        if (best_change > 0.0 && k >= best + kCompared) {
            moves.push_back(found);
            best_change = 0.0;
        }
        if (change > 1.0 && change > best_change) {
            best = k;
            best_change = change;
            found = {places[k - 1], places[k], tilt_deg, MilliGal(norm_mgal)};
        }
    }
    if (best_change > 0.0) moves.push_back(found);
    return moves;
}

StillPart choose_still_part(std::span<const MotionSample> samples,
                            const std::vector<BoxMove>& moves) {
    const std::vector<bool> rest = at_rest(samples);
    StillPart longest;
    std::ptrdiff_t most = -1;
    for (std::size_t k = 0; k <= moves.size(); ++k) {
        const StillPart part{k == 0 ? 0 : moves[k - 1].after,
                             k == moves.size() ? samples.size() : moves[k].before + 1};
        const auto still = std::count(rest.begin() + static_cast<std::ptrdiff_t>(part.first),
                                      rest.begin() + static_cast<std::ptrdiff_t>(part.end), true);
        if (still > most) {
            most = still;
            longest = part;
        }
        if (still >= static_cast<std::ptrdiff_t>(kLeastStay)) break;
    }
    const auto is_carried = [&](std::size_t from, std::size_t to) {
        return shaken_in(samples, from, to) >= kCarried;
    };
    if (most == 0)
        return is_carried(0, samples.size()) ? StillPart{} : StillPart{0, samples.size()};
    StillPart at_rest = longest;
    while (at_rest.first < at_rest.end && !rest[at_rest.first]) ++at_rest.first;
    while (at_rest.end > at_rest.first && !rest[at_rest.end - 1]) --at_rest.end;
    if (is_carried(longest.first, at_rest.first)) longest.first = at_rest.first;
    if (is_carried(at_rest.end, longest.end)) longest.end = at_rest.end;
    if (longest.end == samples.size()) return longest;
    // Back to the last handling, if there is one and the stay is not over before it.
    const std::size_t from =
        std::max(longest.first + kLeastStay, longest.end - std::min(longest.end, kWayToCar));
    for (std::size_t end = longest.end; end > from; --end) {
        std::size_t begin = end;
        while (begin > from && is_shaken(samples[begin - 1])) --begin;
        if (end - begin >= kHandled) {
            longest.end = begin;
            break;
        }
        if (begin < end) end = begin + 1;
    }
    return longest;
}

bool was_only_lifted(std::span<const MotionSample> samples, const std::vector<BoxMove>& moves) {
    const auto is_lift = [&](const BoxMove& move) {
        return samples[move.after].time - samples[move.before].time <= kLift &&
               shaken_in(samples, move.before, move.after) >= kHandled &&
               std::abs(move.norm.value()) < kSamePlace_mgal;
    };
    if (moves.empty() || !std::ranges::all_of(moves, is_lift)) return false;
    const std::vector<bool> rest = at_rest(samples);
    for (std::size_t k = 0; k <= moves.size(); ++k) {
        const std::size_t first = k == 0 ? 0 : moves[k - 1].after,
                          end = k == moves.size() ? samples.size() : moves[k].before + 1;
        const auto still = std::count(rest.begin() + static_cast<std::ptrdiff_t>(first),
                                      rest.begin() + static_cast<std::ptrdiff_t>(end), true);
        if (still < static_cast<std::ptrdiff_t>(kLeastStay)) return false;
        if (shaken_in(samples, first, end) >= kCarried) return false;
    }
    return true;
}

AnsweredStay answered_stay(std::span<const MotionSample> samples,
                           std::optional<UtcTime> not_moved_until) {
    std::vector<BoxMove> moves = find_box_moves(samples);
    if (not_moved_until)
        std::erase_if(moves, [&](const BoxMove& move) {
            return samples[move.after].time <= *not_moved_until;
        });
    StillPart part = choose_still_part(samples, moves);
    if (!not_moved_until || samples.empty()) return {part, std::move(moves)};
    const auto is_answered = [&](std::size_t place) {
        return samples[std::min(place, samples.size() - 1)].time <= *not_moved_until;
    };
    if (part.first == part.end) {  // shaken throughout
        if (is_answered(samples.size())) part = {0, samples.size()};
        return {part, std::move(moves)};
    }
    if (part.first > 0 && is_answered(part.first)) part.first = 0;
    // The last handling before a move may be the one that was answered.
    if (part.end < samples.size() && is_answered(part.end))
        part.end =
            moves.empty() ? samples.size() : (moves.front().before + moves.front().after) / 2;
    return {part, std::move(moves)};
}

}  // namespace a351::signal
