#include "corrector/reading/stay_remarks.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace a351::corrector::reading {
namespace {

/// A stay is short if it is shorter than both kLongEnough and the median divided by kShortDivisor.
/// Reason: from 6 min on the placement is the larger part of the error (accuracy.md).
constexpr int kShortDivisor = 2;
constexpr std::chrono::minutes kLongEnough(6);
/// Fewest stays that are compared with their median.
constexpr std::size_t kFewestCompared = 5;
/// Errors of the clock above this are named.  Reason: the ends of a stay are known to a second, and in
/// a second the tide changes by less than 0.1 uGal.
constexpr std::chrono::seconds kLeastError(1);
constexpr int kLeastErrorQuality_percent = 40;  // timing_quality_percent() of kLeastError

Finding remark(FindingKind kind, const OccupationWindow& window, UtcTime time) {
    Finding finding{.kind = kind, .code = std::string(to_text(kind))};
    set_stay(finding, window, time);
    return finding;
}

void add_missing_stops(std::vector<Finding>& findings,
                       const std::vector<OccupationWindow>& windows) {
    for (const OccupationWindow& window : windows) {
        if (!window.has_note("no-stop") || window.has_note("moved") || window.has_note("retimed") ||
            window.has_note("excluded"))
            continue;
        Finding& finding = findings.emplace_back(remark(FindingKind::no_stop, window, window.end));
        if (window.is_last) finding.code = "no_stop_last";
        finding.text = text::message(
            "{} ({}) has no stop: it lasts until the {}, at {}", window.site, window.occupation,
            window.is_last ? text::message("end of the record") : text::message("next start"),
            to_rfc3339(window.end));
    }
}

void add_short_stays(std::vector<Finding>& findings, const std::vector<OccupationWindow>& windows) {
    struct Stay {
        const OccupationWindow* first = nullptr;
        Nanoseconds length{};
        bool is_compared = true;
    };
    std::vector<Stay> stays;
    std::map<std::pair<std::string, int>, std::size_t> places;
    for (const OccupationWindow& window : windows) {
        const auto [place, is_new] =
            places.emplace(std::pair(window.site, window.occupation), stays.size());
        if (is_new) stays.push_back({&window});
        Stay& stay = stays[place->second];
        stay.length += window.end - window.start;
        if (window.is_last || window.has_note("excluded") || window.has_note("divided"))
            stay.is_compared = false;
    }
    std::erase_if(stays, [](const Stay& stay) { return !stay.is_compared; });
    if (stays.size() < kFewestCompared) return;
    std::vector<Nanoseconds> lengths;
    for (const Stay& stay : stays) lengths.push_back(stay.length);
    std::ranges::sort(lengths);
    const Nanoseconds median = lengths[lengths.size() / 2];
    for (const Stay& stay : stays) {
        if (stay.length >= std::min<Nanoseconds>(kLongEnough, median / kShortDivisor)) continue;
        Finding& finding =
            findings.emplace_back(remark(FindingKind::short_stay, *stay.first, stay.first->start));
        finding.text = text::message(
            "{} ({}) has {}, less than half the day's median of {}: its noise is averaged less",
            stay.first->site, stay.first->occupation, in_minutes(stay.length), in_minutes(median));
    }
}

/// Returns the uncertainty that a timing quality means, s: the inverse of timing_quality_percent().
double uncertainty_s(int timing_quality_percent) {
    constexpr double kPercentPerDecade = 20.0, kBest_s = 1e-3;
    return kBest_s * std::pow(10.0, (100.0 - timing_quality_percent) / kPercentPerDecade);
}

std::optional<Finding> uncertain_times(const std::vector<OccupationWindow>& windows,
                                       const archive::ChannelData& axis) {
    std::size_t uncertain = 0;
    int worst_percent = kLeastErrorQuality_percent;
    for (const OccupationWindow& window : windows) {
        std::size_t count = 0, bad = 0;
        int percent = kLeastErrorQuality_percent;
        for (const archive::Segment& segment : axis.segments)
            for (const archive::Segment::Anchor& anchor : segment.anchors) {
                if (anchor.time < window.start || anchor.time >= window.end) continue;
                ++count;
                if (!anchor.is_time_questionable) continue;
                if (anchor.timing_quality_percent < kLeastErrorQuality_percent) ++bad;
                percent = std::min(percent, anchor.timing_quality_percent);
            }
        if (2 * bad <= count) continue;
        ++uncertain;
        worst_percent = std::min(worst_percent, percent);
    }
    if (uncertain == 0) return std::nullopt;
    Finding finding{.kind = FindingKind::clock, .code = "clock_uncertain"};
    finding.text = text::message(
        "the times of {} of {} set-ups are uncertain by up to {:.0f} s: the host's clock was not "
        "synchronised",
        uncertain, windows.size(), uncertainty_s(worst_percent));
    return finding;
}

void add_steps_back(std::vector<Finding>& findings, const archive::ChannelData& axis) {
    if (axis.segments.empty()) return;
    UtcTime end = axis.segments.front().anchors.front().time;
    for (const archive::Segment& segment : axis.segments) {
        const UtcTime start = segment.anchors.front().time;
        if (start <= end - kLeastError) {
            Finding& finding = findings.emplace_back(
                Finding{.kind = FindingKind::clock, .code = "clock_set_back", .time = start});
            finding.text =
                text::message("the host's clock was set back by {:.1f} s: two records are of {}",
                              seconds_between(start, end), to_rfc3339(start));
        }
        end = std::max(end, segment.time_of(segment.counts.size()));
    }
}

}  // namespace

std::vector<Finding> stay_remarks(const std::vector<OccupationWindow>& windows,
                                  const archive::ChannelData& axis) {
    std::vector<Finding> findings;
    add_missing_stops(findings, windows);
    add_short_stays(findings, windows);
    if (auto finding = uncertain_times(windows, axis)) findings.push_back(std::move(*finding));
    add_steps_back(findings, axis);
    return findings;
}

std::optional<Finding> mostly_without_samples(std::size_t without_samples, std::size_t set_ups) {
    if (2 * without_samples <= set_ups) return std::nullopt;
    return Finding{.kind = FindingKind::clock,
                   .code = "without_samples",
                   .text = text::message("{} of {} set-ups have no samples: check when the sensor "
                                         "recorded, and date, hour and zone of the stays",
                                         without_samples, set_ups)};
}

std::optional<Finding> other_face(const OccupationWindow& window, int face) {
    const auto expected = window.face.expected();
    if (!expected || *expected == face) return std::nullopt;
    Finding finding = remark(FindingKind::turned, window, window.start);
    finding.code = window.face.entered ? "face_entered" : "turn_forgotten";
    const std::string time = to_rfc3339(window.start);
    const auto is = events::sign_of(face), other = events::sign_of(*expected);
    finding.text =
        window.face.entered
            ? text::message(
                  "{} ({}): the set-up at {} is in face {}, but face {} was entered; the "
                  "data decide, so the reading is right",
                  window.site, window.occupation, time, is, other)
            : text::message(
                  "{} ({}): the set-up at {} is in face {}, but the plan asked for face "
                  "{}: a turn was forgotten; the reading is used as it is",
                  window.site, window.occupation, time, is, other);
    return finding;
}

}  // namespace a351::corrector::reading
