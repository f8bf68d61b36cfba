#include "corrector/reading/moved_stay.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/signal/move_meaning.hpp"

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

/// Returns the entries at begin and end of a set-up.  Within a stay they are *Next set-up*.
signal::EnteredSetUp entered(const std::vector<OccupationWindow>& windows, std::size_t i) {
    const OccupationWindow& window = windows[i];
    signal::EnteredSetUp set_up{window.start, window.end};
    set_up.not_moved_until = window.not_moved_until;
    set_up.began_with_next_set_up = i > 0 && is_same_stay(windows[i - 1], window);
    if (i + 1 < windows.size() && is_same_stay(windows[i + 1], window))
        set_up.ended_by = signal::SetUpEnd::next_set_up;
    else if (window.has_note("no-stop"))
        set_up.ended_by = signal::SetUpEnd::not_stopped;
    else if (window.is_last)
        set_up.ended_by = signal::SetUpEnd::running;
    return set_up;
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

/// Says that the box was carried off before the stop, or set down after the start, with an amendment of
/// these times.
Finding other_times(const OccupationWindow& window, const OccupationWindow& still, bool is_early,
                    bool is_late) {
    const bool is_end = is_late || !is_early;  // an early start alone is a remark
    Finding finding{.kind = is_end ? FindingKind::moved_box : FindingKind::early_start,
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
    return finding;
}

}  // namespace

std::optional<MovedStay> moved_stay(const std::vector<OccupationWindow>& windows, std::size_t i,
                                    const OccupationRecord& record, const DecimatedAxes& axes) {
    using signal::MoveMeaning;
    const OccupationWindow& window = windows[i];
    for (const char* const seen : {"retimed", "excluded", "included"})
        if (window.has_note(seen)) return std::nullopt;
    const auto samples = motion_of(record, axes);
    const signal::JudgedSetUp judged = signal::judge_moves(samples, entered(windows, i));
    const signal::StillPart part = judged.part;
    if (part == signal::StillPart{0, samples.size()}) return std::nullopt;
    MovedStay moved{window, {}};
    OccupationWindow& still = moved.still;
    // A part of a set-up is only cut where it was divided: no amendment can name it.
    const bool is_divided = window.has_note("divided");
    if (part.first == part.end) {
        if (is_divided) return std::nullopt;
        still.notes.emplace_back("shaken");
        moved.finding = Finding{
            .kind = FindingKind::bad_reading,
            .code = "never_at_rest",
            .text = text::message("{} ({}): the box was never at rest: repeat the reading",
                                  window.site, window.occupation),
            .amendment = amendment_head("exclude", window.listed) + "reason = \"never at rest\"\n",
            .is_headline = true};
        set_stay(*moved.finding, window, window.start);
        return moved;
    }
    if (part.first > 0) still.start = samples[part.first].time;
    if (part.end < samples.size()) still.end = samples[part.end].time;
    const bool is_early = judged.at_start == MoveMeaning::early_start;
    const bool is_forgotten = judged.at_end == MoveMeaning::forgotten_set_up;
    if (is_forgotten && !is_early)
        moved.finding = missed_set_up(window, samples, judged.forgotten);
    else if (is_early || is_forgotten || judged.at_end == MoveMeaning::late_stop)
        moved.finding = other_times(window, still, is_early,
                                    is_forgotten || judged.at_end == MoveMeaning::late_stop);
    if (!moved.finding) return moved;
    if (is_divided) return std::nullopt;
    still.notes.emplace_back("moved");
    return moved;
}

}  // namespace a351::corrector::reading
