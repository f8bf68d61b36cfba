#include "protocol/signal/move_meaning.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace a351::signal {
namespace {

// In samples of 2 s.
constexpr std::size_t kCarried = 30;    // a minute; handling takes up to 25 s
constexpr std::size_t kDriven = 60;     // two minutes; levelling takes one, a lorry less
constexpr std::size_t kPause = 30;      // a minute; a car stops at lights for less
constexpr std::size_t kLeastStay = 90;  // three minutes
constexpr std::size_t kWayToCar = 300;  // ten minutes
constexpr std::chrono::minutes kPressedAfter(10), kPressedBefore(1);  // *Next set-up* and a move
constexpr std::chrono::minutes kLift(3);  // lifting, turning and levelling again
constexpr double kSamePlace_mgal = 5.0;   // three standard deviations of two placements

using Samples = std::span<const MotionSample>;

/// The samples of a set-up, and what follows from each alone.
struct Motion {
    Samples samples;
    std::vector<bool> rest;
    std::size_t said = 0;  ///< First sample after the operator's answer.

    [[nodiscard]] std::size_t size() const { return samples.size(); }
    /// Returns the number of samples at rest in [from, to).
    [[nodiscard]] std::size_t still_in(std::size_t from, std::size_t to) const {
        return static_cast<std::size_t>(std::count(rest.begin() + static_cast<std::ptrdiff_t>(from),
                                                   rest.begin() + static_cast<std::ptrdiff_t>(to),
                                                   true));
    }
    [[nodiscard]] bool is_carried(std::size_t from, std::size_t to) const {
        const auto shaken = std::ranges::count_if(samples.subspan(from, to - from), is_shaken);
        return shaken >= static_cast<std::ptrdiff_t>(kCarried);
    }
    [[nodiscard]] bool is_driven(std::size_t from, std::size_t to) const {
        std::size_t shaken = 0, still = 0;
        for (std::size_t i = from; i < to && shaken < kDriven; ++i) {
            still = rest[i] ? still + 1 : 0;
            if (still >= kPause) shaken = 0;
            if (is_shaken(samples[i])) ++shaken;
        }
        return shaken >= kDriven;
    }
    /// Returns the time of the first shaken sample in [from, to), or else of the last one.
    [[nodiscard]] UtcTime lifted_at(std::size_t from, std::size_t to) const {
        while (from + 1 < to && !is_shaken(samples[from])) ++from;
        return samples[from].time;
    }
};

/// Returns the moves after the answer; those with less than kLeastStay at rest between them as one.
std::vector<BoxMove> moves_of(const Motion& motion) {
    std::vector<BoxMove> moves;
    for (const BoxMove& move : find_box_moves(motion.samples)) {
        if (move.after < motion.said) continue;
        if (moves.empty() || motion.still_in(moves.back().after, move.before + 1) >= kLeastStay) {
            moves.push_back(move);
            continue;
        }
        BoxMove& whole = moves.back();
        whole.after = move.after;
        whole.tilt_deg = std::max(whole.tilt_deg, move.tilt_deg);
        whole.norm = whole.norm + move.norm;
    }
    return moves;
}

StillPart still_part(const Motion& motion, const std::vector<BoxMove>& moves) {
    StillPart longest;
    std::size_t most = 0;
    for (std::size_t k = 0; k <= moves.size(); ++k) {
        const StillPart part{
            k == 0 ? 0 : moves[k - 1].after,
            k == moves.size() ? motion.size() : std::max(moves[k].before + 1, motion.said)};
        const std::size_t still = motion.still_in(part.first, part.end);
        if (still > most) {
            most = still;
            longest = part;
        }
        if (still >= kLeastStay) break;
    }
    if (most == 0)
        return motion.is_carried(motion.said, motion.size()) ? StillPart{}
                                                             : StillPart{0, motion.size()};
    StillPart at_rest = longest;
    while (at_rest.first >= motion.said && !motion.rest[at_rest.first]) ++at_rest.first;
    while (at_rest.end > motion.said && !motion.rest[at_rest.end - 1]) --at_rest.end;
    if (motion.is_carried(longest.first, at_rest.first)) longest.first = at_rest.first;
    if (motion.is_carried(at_rest.end, longest.end)) longest.end = at_rest.end;
    return longest;
}

MoveMeaning meaning_at_start(const Motion& motion, std::size_t first, const EnteredSetUp& entered) {
    if (first == 0) return MoveMeaning::none;
    return entered.began_with_next_set_up &&
                   motion.lifted_at(0, first) - entered.start <= kPressedBefore &&
                   !motion.is_driven(0, first)
               ? MoveMeaning::change_of_set_ups
               : MoveMeaning::early_start;
}

/// Sets the meaning of the end of a part that ends before the last sample.
/// @param late  moves after the part.
void set_meaning_at_end(JudgedSetUp& judged, const Motion& motion, std::vector<BoxMove> late,
                        const EnteredSetUp& entered) {
    std::size_t end = motion.size();
    if (entered.ended_by == SetUpEnd::next_set_up) {
        const std::size_t from = late.empty() ? judged.part.end : late.back().before + 1;
        const std::size_t to = late.empty() ? end : late.back().after + 1;
        if (entered.end - motion.lifted_at(from, to) <= kPressedAfter &&
            !motion.is_driven(from, end)) {
            judged.at_end = MoveMeaning::change_of_set_ups;
            if (late.size() <= 1) return;
            late.pop_back();  // The box was moved before this change too.
            end = from;
        }
    }
    judged.at_end = MoveMeaning::late_stop;
    const bool is_running = entered.ended_by == SetUpEnd::running;
    if (late.empty()) {
        if (is_running && end - judged.part.end < kDriven)
            judged.at_end = MoveMeaning::may_be_change;
        return;
    }
    const std::size_t still = motion.still_in(late.back().after, end);
    if (motion.is_driven(judged.part.end, end)) return;
    if (is_running && is_handled(motion.samples, judged.part.end, end) && still < kLeastStay) {
        judged.at_end = MoveMeaning::may_be_change;
        return;
    }
    const auto is_lift = [&](const BoxMove& move) {
        return motion.samples[move.after].time - motion.samples[move.before].time <= kLift &&
               is_handled(motion.samples, move.before, move.after) &&
               std::abs(move.norm.value()) < kSamePlace_mgal;
    };
    if (entered.ended_by == SetUpEnd::not_stopped || still < kPause ||
        !std::ranges::all_of(late, is_lift))
        return;
    judged.at_end = MoveMeaning::forgotten_set_up;
    judged.forgotten = std::move(late);
}

/// Returns the end of a part before a late stop: the last handling, if there is one and the stay is not
/// over before it.
std::size_t end_at_handling(const Motion& motion, const StillPart& part) {
    const std::size_t from =
        std::max({part.first + kLeastStay, motion.said, part.end - std::min(part.end, kWayToCar)});
    for (std::size_t end = part.end; end > from; --end) {
        std::size_t begin = end;
        while (begin > from && is_shaken(motion.samples[begin - 1])) --begin;
        if (is_handled(motion.samples, begin, end)) return begin;
        if (begin < end) end = begin + 1;
    }
    return part.end;
}

}  // namespace

JudgedSetUp judge_moves(std::span<const MotionSample> samples, const EnteredSetUp& entered) {
    Motion motion{samples, at_rest(samples)};
    if (const auto until = entered.not_moved_until)
        while (motion.said < samples.size() && samples[motion.said].time <= *until) ++motion.said;
    const std::vector<BoxMove> moves = moves_of(motion);
    JudgedSetUp judged{.part = still_part(motion, moves)};
    StillPart& part = judged.part;
    if (part.first == part.end) return judged;
    judged.at_start = meaning_at_start(motion, part.first, entered);
    if (part.end == samples.size()) return judged;
    std::vector<BoxMove> late;
    std::ranges::copy_if(moves, std::back_inserter(late),
                         [&](const BoxMove& move) { return move.after >= part.end; });
    set_meaning_at_end(judged, motion, std::move(late), entered);
    if (judged.at_end == MoveMeaning::late_stop) part.end = end_at_handling(motion, part);
    return judged;
}

}  // namespace a351::signal
