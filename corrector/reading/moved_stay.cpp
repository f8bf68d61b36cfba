#include "corrector/reading/moved_stay.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/signal/moved_box.hpp"

namespace a351::corrector::reading {
namespace {

using Axis = TimeSeries<StandardGravity>;

/// Returns half peak to peak of the raw samples around decimated sample k, g; NaN without samples.
double shake_of(const Axis& axis, std::size_t k) {
    const std::size_t first =
        k * kDecimationRatio - std::min(k * kDecimationRatio, kDecimationRatio / 2);
    const std::size_t end = std::min(axis.size(), k * kDecimationRatio + kDecimationRatio / 2);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t i = first; i < end; ++i) {  // NaN changes neither
        least = std::min(least, axis.values()[i]);
        most = std::max(most, axis.values()[i]);
    }
    return least <= most ? 0.5 * (most - least) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<signal::MotionSample> motion_of(const OccupationRecord& record,
                                            const DecimatedAxes& axes) {
    std::vector<signal::MotionSample> samples;
    for (std::size_t k = 0; k < axes.x.size(); ++k) {
        signal::MotionSample sample;
        sample.time = axes.x.time_of(static_cast<double>(k));
        sample.axes = {to_milligal(StandardGravity(axes.x.values()[k])),
                       to_milligal(StandardGravity(axes.y.values()[k])),
                       to_milligal(StandardGravity(axes.z.values()[k]))};
        double shake = std::numeric_limits<double>::quiet_NaN();
        for (const Axis* axis : {&record.x, &record.y, &record.z})
            shake = std::fmax(shake, shake_of(*axis, k));
        sample.shake = to_milligal(StandardGravity(shake));
        samples.push_back(sample);
    }
    return samples;
}

/// Says that the box was lifted and set down, with an amendment that divides the set-up there.
Finding missed_set_up(const OccupationWindow& window,
                      const std::vector<signal::MotionSample>& samples,
                      const std::vector<signal::BoxMove>& moves) {
    Finding finding{.kind = FindingKind::missed_set_up, .code = "missed_set_up"};
    const auto time_of = [&](const signal::BoxMove& move) {
        const UtcTime before = samples[move.before].time;
        return before + (samples[move.after].time - before) / 2;
    };
    set_stay(finding, window, time_of(moves.front()));
    std::string times;
    ListedSetUp listed = window.listed;
    listed.set_up.reset();  // the instant says which
    for (const signal::BoxMove& move : moves) {
        times += (times.empty() ? "" : ", ") + to_rfc3339(time_of(move));
        finding.amendment += amendment_head("set_up", listed) +
                             fmt::format("time_utc = \"{}\"\nreason = \"lifted and set down\"\n",
                                         to_rfc3339(time_of(move), 3));
    }
    finding.text = text::message(
        "{} ({}): box lifted and set down at {} without a set-up (its level changed by "
        "{:.3f} deg); only the part before is used",
        window.site, window.occupation, times, moves.front().tilt_deg);
    return finding;
}

}  // namespace

std::optional<MovedStay> moved_stay(const OccupationWindow& window, const OccupationRecord& record,
                                    const DecimatedAxes& axes) {
    for (const char* const seen : {"retimed", "excluded", "included", "divided"})
        if (std::ranges::count(window.notes, seen) > 0) return std::nullopt;
    const auto samples = motion_of(record, axes);
    const auto [part, moves] = signal::answered_stay(samples, window.not_moved_until);
    if (part == signal::StillPart{0, samples.size()}) return std::nullopt;
    MovedStay moved{window, {}};
    OccupationWindow& still = moved.still;
    if (part.first == part.end) {
        still.notes.emplace_back("shaken");
        moved.finding = {
            .kind = FindingKind::bad_reading,
            .code = "never_at_rest",
            .text = text::message("{} ({}): the box was never at rest: repeat the reading",
                                  window.site, window.occupation),
            .amendment = amendment_head("exclude", window.listed) + "reason = \"never at rest\"\n",
            .is_headline = true};
        set_stay(moved.finding, window, window.start);
        return moved;
    }
    still.notes.emplace_back("moved");
    if (part.first > 0) still.start = samples[part.first].time;
    if (part.end < samples.size()) still.end = samples[part.end].time;

    Finding& finding = moved.finding;
    // Without a stop the stay lasts until the box is at the next benchmark.
    if (std::ranges::count(window.notes, "no-stop") == 0 &&
        signal::was_only_lifted(samples, moves)) {
        finding = missed_set_up(window, samples, moves);
        return moved;
    }
    const bool is_early = still.start != window.start, is_late = still.end != window.end;
    const bool is_end = is_late || !is_early;  // an early start alone is a remark
    finding = {.kind = is_end ? FindingKind::moved_box : FindingKind::early_start,
               .code = !is_end    ? "early_start"
                       : is_early ? "moved_at_both_ends"
                                  : "moved_at_end",
               .is_headline = is_end};
    set_stay(finding, window, is_end ? still.end : still.start);
    text::Message what;
    if (is_early)
        what = text::message("moved until {}, {} after its start; the stay begins there",
                             to_rfc3339(still.start), in_minutes(still.start - window.start));
    if (is_early && is_late) what += "; ";
    if (is_late)
        what += text::message("moved at {}, {} before its end was entered; the stay ends there",
                              to_rfc3339(still.end), in_minutes(window.end - still.end));
    finding.text = text::message("{} ({}): box {}", window.site, window.occupation, what);
    finding.amendment =
        amendment_head("retime", window.listed) +
        fmt::format("start_utc = \"{}\"\nend_utc = \"{}\"\nreason = \"box moved\"\n",
                    to_rfc3339(still.start, 3), to_rfc3339(still.end, 3));
    return moved;
}

}  // namespace a351::corrector::reading
