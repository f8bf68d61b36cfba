#include "corrector/long_record/record_segments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "corrector/archive_series/wrong_profile.hpp"
#include "corrector/reading/disturbance.hpp"
#include "protocol/core/sensor_limits.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::long_record {
namespace {

constexpr std::size_t kBeside = 9;  // samples of the median on either side of a step: 3 min
// Largest difference of equal values: rounding of a constant by three filters.
constexpr double kSame_degc = 1e-9, kSame_mgal = 1e-6;
// Least number of equal samples of a stuck temperature, axis or acceleration: 20 min.  Reason: the
// noise of a working sensor changes the last digits.
constexpr std::size_t kStuck = 60;
// Least step of the acceleration, in units of 1.4826 MAD of all such differences, and in mGal; both
// limits must be exceeded.  A step is the difference between the medians of kBeside samples after
// and before; the box was moved.
constexpr double kStepThreshold = 8.0, kLeastStep_mgal = 5.0;
constexpr double kKnockThreshold = 8.0;  // threshold of find_disturbances()
// Change of temperature across a gap, degC, above which the sensor must have been without power.
// Reason: five times the swing of the oven's cycle.
constexpr double kRestart_degc = 0.1;

double median_of(const std::vector<double>& values, std::size_t first, std::size_t end) {
    return signal::median({values.begin() + static_cast<std::ptrdiff_t>(first),
                           values.begin() + static_cast<std::ptrdiff_t>(end)});
}

/// Valid samples of a stretch.
struct Valid {
    std::vector<std::size_t> places;  ///< Their numbers in the stretch.
    std::vector<double> quantity, temperature_degc;

    [[nodiscard]] std::size_t size() const noexcept { return places.size(); }
};

/// Samples of equal value, at least kStuck.
struct EqualRun {
    std::size_t first = 0, end = 0;

    [[nodiscard]] std::size_t size() const noexcept { return end - first; }
};

std::vector<EqualRun> equal_runs(const std::vector<double>& values, double same) {
    std::vector<EqualRun> runs;
    for (EqualRun run; run.first < values.size(); run.first = run.end) {
        run.end = run.first + 1;
        while (run.end < values.size() && std::abs(values[run.end] - values[run.first]) < same)
            ++run.end;
        if (run.size() >= kStuck) runs.push_back(run);
    }
    return runs;
}

/// Removes the runs that a thermometer of coarse resolution has in a good oven.
///
/// Its value changes by a step of the resolution at each end of a run; the resolution is the least
/// change in the stretch.  A thermometer that was stuck continues elsewhere.  At an end of the
/// stretch only one side can be seen: such a run may last twice as long as the longest inner one.
void remove_coarse_runs(std::vector<EqualRun>& runs, const std::vector<double>& values,
                        double same) {
    double resolution = std::numeric_limits<double>::infinity();
    std::vector<double> finite;
    std::vector<std::size_t> place(values.size() + 1, 0);  // number of finite values before each
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isfinite(values[i])) {
            if (!finite.empty() && std::abs(values[i] - finite.back()) >= same)
                resolution = std::min(resolution, std::abs(values[i] - finite.back()));
            finite.push_back(values[i]);
        }
        place[i + 1] = finite.size();
    }
    constexpr double kMostSteps = 2.5;
    const auto is_step = [&](std::size_t before, std::size_t after) {
        return std::abs(finite[after] - finite[before]) <= kMostSteps * resolution;
    };
    constexpr std::size_t kEndFactor = 2;
    std::size_t longest_inner = 0;
    for (const bool is_inner : {true, false}) {
        std::erase_if(runs, [&](const EqualRun& run) {
            const std::size_t first = place[run.first], end = place[run.end];
            const bool has_both = first > 0 && end < finite.size();
            if (has_both != is_inner || finite.empty() || !std::isfinite(values[run.first]) ||
                (first > 0 && !is_step(first - 1, first)) ||
                (end < finite.size() && !is_step(end - 1, end)))
                return false;
            if (is_inner) longest_inner = std::max(longest_inner, run.size());
            return is_inner || run.size() <= kEndFactor * longest_inner;
        });
    }
}

Valid valid_samples(const RecordStretch& stretch, const std::vector<bool>& is_refused) {
    Valid valid;
    for (std::size_t i = 0; i < stretch.size(); ++i) {
        if (is_refused[i] || !std::isfinite(stretch.quantity[i]) ||
            !std::isfinite(stretch.temperature_degc[i]))
            continue;
        valid.places.push_back(i);
        valid.quantity.push_back(stretch.quantity[i]);
        valid.temperature_degc.push_back(stretch.temperature_degc[i]);
    }
    return valid;
}

/// Returns the size of the step before each valid sample, mGal; 0 if there is none.
std::vector<double> find_steps(const std::vector<double>& values) {
    const std::size_t count = values.size();
    std::vector<double> steps(count, 0.0);
    if (count < 4 * kBeside) return steps;
    std::vector<double> rises(count, 0.0), sizes;
    for (std::size_t i = kBeside; i + kBeside <= count; ++i) {
        rises[i] = median_of(values, i, i + kBeside) - median_of(values, i - kBeside, i);
        sizes.push_back(std::abs(rises[i]));
    }
    const double limit =
        std::max(kStepThreshold * signal::kGaussianPerMad * signal::median(sizes), kLeastStep_mgal);
    // One step gives large differences of medians for several samples: they count as one step.
    for (std::size_t i = kBeside; i + kBeside <= count;) {
        if (std::abs(rises[i]) <= limit) {
            ++i;
            continue;
        }
        // The step is at the greatest single change within the run of large differences.
        std::size_t end = i;
        while (end + kBeside <= count && std::abs(rises[end]) > limit) ++end;
        std::size_t at = i;
        for (std::size_t k = i; k < end; ++k)
            if (std::abs(values[k] - values[k - 1]) > std::abs(values[at] - values[at - 1])) at = k;
        steps[at] = rises[at];
        i = end;
    }
    return steps;
}

/// Start of a segment.
struct Begin {
    text::Message why;
    bool is_restart = false;
};

Begin begin_after_gap(double seconds, double change_degc) {
    Begin begin{text::message("gap of {} s", text::fixed(seconds, 0)),
                std::abs(change_degc) > kRestart_degc};
    if (begin.is_restart)
        begin.why +=
            text::message(" with {} degC between its ends: a restart", text::fixed(change_degc, 2));
    return begin;
}

class Divider {
public:
    Divider(const LongRecord& record, std::size_t shortest)
        : record_(record), shortest_(shortest) {}

    [[nodiscard]] RecordSegments divide() {
        for (const RecordStretch& stretch : record_.stretches) add_stretch(stretch);
        std::ranges::stable_sort(result_.refused, {}, &RefusedPart::start);
        return std::move(result_);
    }

private:
    void add_stretch(const RecordStretch& stretch) {
        const std::vector<bool> is_refused = refuse_values(stretch);
        const Valid valid = valid_samples(stretch, is_refused);
        if (valid.size() == 0) return;
        const std::vector<double> steps = find_steps(valid.quantity);
        std::size_t first = 0;
        Begin begin = begin_of(stretch, valid);
        for (std::size_t i = 1; i <= valid.size(); ++i) {
            Begin next;
            if (i < valid.size()) {
                if (valid.places[i] - valid.places[i - 1] - 1 > kLongestBridge)
                    next = begin_at(stretch, is_refused, valid, i);
                else if (steps[i] != 0.0)
                    next.why =
                        text::message("step of {} {}", text::fixed(steps[i], 1), record_.unit);
                if (next.why.empty()) continue;
            }
            add(stretch, valid, first, i, begin);
            first = i;
            begin = std::move(next);
        }
        last_end_ = stretch.times.back();
        last_temperature_ = level(valid, valid.size() - std::min(valid.size(), kBeside));
    }

    std::vector<bool> refuse_values(const RecordStretch& stretch) {
        std::vector<bool> is_refused(stretch.size(), false);
        std::vector<EqualRun> still = equal_runs(stretch.temperature_degc, kSame_degc);
        remove_coarse_runs(still, stretch.temperature_degc, kSame_degc);
        refuse_stuck(is_refused, stretch, stretch.temperature_degc, still,
                     text::marked("the temperature"), "degC");
        // The norm has the tide subtracted, so it varies even if the sensor is stuck.  The axes
        // still contain the tide: they are tested if the record has them.
        constexpr std::array kNames{text::marked("the x axis"), text::marked("the y axis"),
                                    text::marked("the z axis")};
        if (stretch.axes_mgal.empty())
            refuse_stuck(is_refused, stretch, stretch.quantity,
                         equal_runs(stretch.quantity, kSame_mgal), text::marked("the acceleration"),
                         "mGal");
        for (std::size_t k = 0; k < stretch.axes_mgal.size(); ++k)
            refuse_stuck(is_refused, stretch, stretch.axes_mgal[k],
                         equal_runs(stretch.axes_mgal[k], kSame_mgal), kNames.at(k), "mGal");
        refuse_unbelievable(is_refused, stretch);
        return is_refused;
    }

    /// Refuses values that no sensor sends, and that are not refused as stuck.  A norm alone may be
    /// relative to another one.
    void refuse_unbelievable(std::vector<bool>& is_refused, const RecordStretch& stretch) {
        const auto& axes = stretch.axes_mgal;
        const auto reason_at = [&](std::size_t i) -> text::Message {
            const double norm_mgal =
                axes.empty() ? kNaN : std::hypot(axes[0][i], axes[1][i], axes[2][i]);
            const StandardGravity norm = to_standard_gravity(MilliGal(norm_mgal));
            const DegC temperature(stretch.temperature_degc[i]);
            if (std::isfinite(norm_mgal) && !is_norm_believable(norm))
                return text::message("the acceleration reads {} g: {}",
                                     text::fixed(norm.value(), 2),
                                     text::marked_message(archive_series::kWrongProfile));
            if (std::isfinite(temperature.value()) && !is_temperature_believable(temperature))
                return text::message("the temperature reads {} degC: {}",
                                     text::fixed(temperature.value(), 1),
                                     text::marked_message(archive_series::kWrongProfile));
            return {};
        };
        bool is_in_part = false;
        for (std::size_t i = 0; i < stretch.size(); ++i) {
            text::Message reason = is_refused[i] ? text::Message{} : reason_at(i);
            const bool was_in_part = std::exchange(is_in_part, !reason.empty());
            if (!is_in_part) continue;
            if (!was_in_part)
                result_.refused.push_back({stretch.times[i], stretch.times[i], std::move(reason)});
            result_.refused.back().end = stretch.times[i];
            is_refused[i] = true;
        }
    }

    void refuse_stuck(std::vector<bool>& is_refused, const RecordStretch& stretch,
                      const std::vector<double>& values, const std::vector<EqualRun>& still,
                      const char* name, const char* unit) {
        for (const EqualRun& run : still) {
            std::fill_n(is_refused.begin() + static_cast<std::ptrdiff_t>(run.first), run.size(),
                        true);
            result_.refused.push_back(
                {stretch.times[run.first], stretch.times[run.end - 1],
                 text::message("{} is stuck at {} {}", text::marked_message(name),
                               text::fixed(values[run.first], 4), unit)});
        }
    }

    /// Returns the median temperature of up to kBeside valid samples from `first` on.
    static double level(const Valid& valid, std::size_t first) {
        return median_of(valid.temperature_degc, first, std::min(valid.size(), first + kBeside));
    }

    [[nodiscard]] Begin begin_of(const RecordStretch& stretch, const Valid& valid) const {
        if (!last_end_) return {text::message("the record begins")};
        Begin begin = begin_after_gap(seconds_between(*last_end_, stretch.times.front()),
                                      level(valid, 0) - last_temperature_);
        if (!stretch.begins_with.empty()) begin.why = stretch.begins_with;
        return begin;
    }

    [[nodiscard]] static Begin begin_at(const RecordStretch& stretch,
                                        const std::vector<bool>& is_refused, const Valid& valid,
                                        std::size_t i) {
        const std::size_t before = valid.places[i - 1], after = valid.places[i];
        for (std::size_t k = before + 1; k < after; ++k)
            if (is_refused[k]) return {text::message("end of the refused values")};
        return begin_after_gap(
            seconds_between(stretch.times[before], stretch.times[after]),
            level(valid, i) - median_of(valid.temperature_degc, i - std::min(i, kBeside), i));
    }

    void add(const RecordStretch& stretch, const Valid& valid, std::size_t first, std::size_t end,
             const Begin& begin) {
        RecordSegment segment;
        segment.start = stretch.times[valid.places[first]];
        segment.end = stretch.times[valid.places[end - 1]];
        segment.serial_number = stretch.serial_number;
        segment.begins_with = begin.why;
        segment.is_restart = begin.is_restart;
        const std::size_t span = valid.places[end - 1] - valid.places[first] + 1;
        if (span < shortest_) {
            const auto hours = [this](std::size_t samples, int decimals) {
                return text::fixed(static_cast<double>(samples) * record_.step_s / kSecondsPerHour,
                                   decimals);
            };
            result_.refused.push_back(
                {segment.start, segment.end,
                 text::message(
                     "too short: {} h after \"{}\"; at least {} h in one piece are needed",
                     hours(span, 2), begin.why, hours(shortest_, 1))});
            return;
        }
        // Within the segment only: beside a step the median is that of the other side.
        const reading::Disturbances knocks = reading::find_disturbances(
            std::span(valid.quantity).subspan(first, end - first), kKnockThreshold);
        std::size_t previous = first;
        for (std::size_t i = first; i < end; ++i) {
            const bool is_end = i == first || i + 1 == end;
            if (knocks.disturbed[i - first] && !is_end) {
                ++segment.disturbed;
                continue;
            }
            append(segment, valid, previous, i);
            previous = i;
        }
        if (!stretch.outer_degc.empty()) {
            const auto first_outer =
                stretch.outer_degc.begin() + static_cast<std::ptrdiff_t>(valid.places[first]);
            segment.outer_degc.assign(first_outer,
                                      first_outer + static_cast<std::ptrdiff_t>(segment.size()));
            if (std::ranges::any_of(segment.outer_degc,
                                    [](double value) { return std::isnan(value); }))
                segment.outer_degc.clear();
        }
        result_.segments.push_back(std::move(segment));
    }

    /// Appends the straight line from valid sample `previous` to valid sample `i`, and sample `i`.
    static void append(RecordSegment& segment, const Valid& valid, std::size_t previous,
                       std::size_t i) {
        const std::size_t steps = valid.places[i] - valid.places[previous];
        const auto line = [steps](double from, double to, std::size_t k) {
            return from + (to - from) * static_cast<double>(k) / static_cast<double>(steps);
        };
        for (std::size_t k = 1; k < steps; ++k) {
            segment.quantity.push_back(line(valid.quantity[previous], valid.quantity[i], k));
            segment.temperature_degc.push_back(
                line(valid.temperature_degc[previous], valid.temperature_degc[i], k));
            ++segment.bridged;
        }
        segment.quantity.push_back(valid.quantity[i]);
        segment.temperature_degc.push_back(valid.temperature_degc[i]);
    }

    const LongRecord& record_;
    std::size_t shortest_;
    RecordSegments result_;
    std::optional<UtcTime> last_end_;
    double last_temperature_ = 0.0;
};

}  // namespace

RecordSegments divide_record(const LongRecord& record, const SegmentOptions& options) {
    return Divider(record, options.shortest).divide();
}

}  // namespace a351::corrector::long_record
