#include "corrector/long_record/record_segments.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "corrector/reading/disturbance.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

constexpr std::size_t kBeside = 9;  // samples of the median on either side of a step: 3 min
// Largest difference of equal values: rounding of a constant by three filters.
constexpr double kSame_degc = 1e-9, kSame_mgal = 1e-6;

double median_of(const std::vector<double>& values, std::size_t first, std::size_t behind) {
    return median({values.begin() + static_cast<std::ptrdiff_t>(first),
                   values.begin() + static_cast<std::ptrdiff_t>(behind)});
}

/// Valid samples of a stretch.
struct Valid {
    std::vector<std::size_t> places;  ///< Their numbers in the stretch.
    std::vector<double> acceleration_mgal, temperature_degc;

    [[nodiscard]] std::size_t size() const noexcept { return places.size(); }
};

std::vector<bool> stuck_samples(const std::vector<double>& values, double same, std::size_t most) {
    std::vector<bool> is_stuck(values.size(), false);
    for (std::size_t first = 0; first < values.size();) {
        std::size_t behind = first + 1;
        while (behind < values.size() && std::abs(values[behind] - values[first]) < same) ++behind;
        if (behind - first >= most)
            std::fill_n(is_stuck.begin() + static_cast<std::ptrdiff_t>(first), behind - first,
                        true);
        first = behind;
    }
    return is_stuck;
}

Valid valid_samples(const RecordStretch& stretch, const std::vector<bool>& is_stuck) {
    Valid valid;
    for (std::size_t i = 0; i < stretch.size(); ++i) {
        if (is_stuck[i] || !std::isfinite(stretch.acceleration_mgal[i]) ||
            !std::isfinite(stretch.temperature_degc[i]))
            continue;
        valid.places.push_back(i);
        valid.acceleration_mgal.push_back(stretch.acceleration_mgal[i]);
        valid.temperature_degc.push_back(stretch.temperature_degc[i]);
    }
    return valid;
}

/// Returns the size of the step before each valid sample, mGal; 0 if there is none.
std::vector<double> find_steps(const std::vector<double>& values, const SegmentOptions& options) {
    const std::size_t count = values.size();
    std::vector<double> steps(count, 0.0);
    if (count < 4 * kBeside) return steps;
    std::vector<double> rises(count, 0.0), sizes;
    for (std::size_t i = kBeside; i + kBeside <= count; ++i) {
        rises[i] = median_of(values, i, i + kBeside) - median_of(values, i - kBeside, i);
        sizes.push_back(std::abs(rises[i]));
    }
    const double limit =
        std::max(options.step_threshold * kGaussianPerMad * median(sizes), options.least_step_mgal);
    // A step also raises the differences of medians next to it.
    for (std::size_t i = kBeside; i + kBeside <= count;) {
        if (std::abs(rises[i]) <= limit) {
            ++i;
            continue;
        }
        // The step is at the greatest single change within the run of large differences.
        std::size_t behind = i;
        while (behind + kBeside <= count && std::abs(rises[behind]) > limit) ++behind;
        std::size_t at = i;
        for (std::size_t k = i; k < behind; ++k)
            if (std::abs(values[k] - values[k - 1]) > std::abs(values[at] - values[at - 1])) at = k;
        steps[at] = rises[at];
        i = behind;
    }
    return steps;
}

class Divider {
public:
    Divider(const LongRecord& record, const SegmentOptions& options)
        : record_(record), options_(options) {}

    [[nodiscard]] RecordSegments divide() {
        for (const RecordStretch& stretch : record_.stretches) add_stretch(stretch);
        return std::move(result_);
    }

private:
    void add_stretch(const RecordStretch& stretch) {
        const std::vector<bool> is_stuck = refuse_stuck_channels(stretch);
        const Valid valid = valid_samples(stretch, is_stuck);
        if (valid.size() == 0) return;
        const std::vector<double> steps = find_steps(valid.acceleration_mgal, options_);
        const Disturbances knocks =
            find_disturbances(valid.acceleration_mgal, options_.disturbance_threshold);
        std::size_t first = 0;
        std::string why = begin_of(stretch, valid);
        bool is_restart = is_restart_;
        for (std::size_t i = 1; i <= valid.size(); ++i) {
            std::string next;
            bool next_is_restart = false;
            if (i < valid.size()) {
                const std::size_t missing = valid.places[i] - valid.places[i - 1] - 1;
                if (missing > options_.longest_bridge) {
                    next = break_text(stretch, is_stuck, valid, i, next_is_restart);
                } else if (steps[i] != 0.0) {
                    next = "step of " + text::fixed(steps[i], 1) + " mGal";
                }
                if (next.empty()) continue;
            }
            add(stretch, valid, knocks, first, i, why, is_restart);
            first = i;
            why = next;
            is_restart = next_is_restart;
        }
        last_end_ = stretch.times.back();
        last_temperature_ =
            level(valid, valid.size() - std::min(valid.size(), kBeside), valid.size());
    }

    std::vector<bool> refuse_stuck_channels(const RecordStretch& stretch) {
        std::vector<bool> is_stuck =
            refuse_stuck(stretch, stretch.temperature_degc, kSame_degc, "the temperature", " degC");
        const auto refuse = [&](const std::vector<double>& values, const std::string& name) {
            const auto is_still = refuse_stuck(stretch, values, kSame_mgal, name, " mGal");
            for (std::size_t i = 0; i < is_stuck.size(); ++i)
                is_stuck[i] = is_stuck[i] || is_still[i];
        };
        // A stuck norm varies after the tide is subtracted, so the axes are tested if there are
        // any.
        constexpr std::array kNames{"the x axis", "the y axis", "the z axis"};
        if (stretch.axes_mgal.empty()) refuse(stretch.acceleration_mgal, "the acceleration");
        for (std::size_t k = 0; k < stretch.axes_mgal.size(); ++k)
            refuse(stretch.axes_mgal[k], kNames.at(k));
        return is_stuck;
    }

    std::vector<bool> refuse_stuck(const RecordStretch& stretch, const std::vector<double>& values,
                                   double same, const std::string& name, const std::string& unit) {
        std::vector<bool> is_stuck = stuck_samples(values, same, options_.stuck);
        const auto trouble = [&](double value) {
            return name + " is stuck at " + text::fixed(value, 4) + unit;
        };
        for (std::size_t i = 0; i < is_stuck.size(); ++i) {
            if (!is_stuck[i] || (i > 0 && is_stuck[i - 1])) continue;
            std::size_t last = i;
            while (last + 1 < is_stuck.size() && is_stuck[last + 1]) ++last;
            result_.refused.push_back({stretch.times[i], stretch.times[last], trouble(values[i])});
        }
        return is_stuck;
    }

    static double level(const Valid& valid, std::size_t first, std::size_t behind) {
        return median_of(valid.temperature_degc, first, behind);
    }

    [[nodiscard]] std::string gap_text(double seconds, double change_degc, bool& is_restart) const {
        std::string text = "gap of " + text::fixed(seconds, 0) + " s";
        is_restart = std::abs(change_degc) > options_.restart_degc;
        if (is_restart)
            text += " with " + text::fixed(change_degc, 2) + " degC between its ends: a restart";
        return text;
    }

    std::string begin_of(const RecordStretch& stretch, const Valid& valid) {
        is_restart_ = false;
        if (!last_end_) return "the record begins";
        const std::string gap = gap_text(
            seconds_between(*last_end_, stretch.times.front()),
            level(valid, 0, std::min(valid.size(), kBeside)) - last_temperature_, is_restart_);
        return stretch.begins_with.empty() ? gap : stretch.begins_with;
    }

    std::string break_text(const RecordStretch& stretch, const std::vector<bool>& is_stuck,
                           const Valid& valid, std::size_t i, bool& is_restart) const {
        for (std::size_t k = valid.places[i - 1] + 1; k < valid.places[i]; ++k)
            if (is_stuck[k]) return "end of the stuck values";
        const double change = level(valid, i, std::min(valid.size(), i + kBeside)) -
                              level(valid, i - std::min(i, kBeside), i);
        return gap_text(
            seconds_between(stretch.times[valid.places[i - 1]], stretch.times[valid.places[i]]),
            change, is_restart);
    }

    void add(const RecordStretch& stretch, const Valid& valid, const Disturbances& knocks,
             std::size_t first, std::size_t behind, const std::string& why, bool is_restart) {
        RecordSegment segment;
        segment.start = stretch.times[valid.places[first]];
        segment.end = stretch.times[valid.places[behind - 1]];
        segment.serial_number = stretch.serial_number;
        segment.begins_with = why;
        segment.is_restart = is_restart;
        const std::size_t span = valid.places[behind - 1] - valid.places[first] + 1;
        if (span < options_.shortest) {
            result_.refused.push_back(
                {segment.start, segment.end,
                 "too short: " +
                     text::fixed(static_cast<double>(span) * record_.step_s / 3600.0, 2) +
                     " h after \"" + why + "\"; at least " +
                     text::fixed(static_cast<double>(options_.shortest) * record_.step_s / 3600.0,
                                 1) +
                     " h in one piece are needed"});
            return;
        }
        std::size_t previous = first;
        for (std::size_t i = first; i < behind; ++i) {
            const bool is_end = i == first || i + 1 == behind;
            if (knocks.disturbed[i] && !is_end) {
                ++segment.disturbed;
                continue;
            }
            append(segment, valid, previous, i);
            previous = i;
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
            segment.acceleration_mgal.push_back(
                line(valid.acceleration_mgal[previous], valid.acceleration_mgal[i], k));
            segment.temperature_degc.push_back(
                line(valid.temperature_degc[previous], valid.temperature_degc[i], k));
            ++segment.bridged;
        }
        segment.acceleration_mgal.push_back(valid.acceleration_mgal[i]);
        segment.temperature_degc.push_back(valid.temperature_degc[i]);
    }

    const LongRecord& record_;
    const SegmentOptions& options_;
    RecordSegments result_;
    std::optional<UtcTime> last_end_;
    double last_temperature_ = 0.0;
    bool is_restart_ = false;
};

}  // namespace

RecordSegments divide_record(const LongRecord& record, const SegmentOptions& options) {
    RecordSegments result = Divider(record, options).divide();
    std::stable_sort(result.refused.begin(), result.refused.end(),
                     [](const RefusedPart& a, const RefusedPart& b) { return a.start < b.start; });
    return result;
}

}  // namespace a351::corrector
