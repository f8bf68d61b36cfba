#include "corrector/long_record/joined_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "corrector/archive_series/epoch.hpp"
#include "corrector/long_record/record_segments.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::long_record {
namespace {

constexpr double kSameStep = 1e-3;  // relative; ten times the error of a sensor's clock

/// A stretch and the part that it comes from.
struct Part {
    RecordStretch stretch;
    std::size_t number;  ///< Number of the part.
    bool is_tide_removed;
};

template <typename T>
void append(std::vector<T>& to, std::size_t missing, const T& gap, const std::vector<T>& from) {
    to.insert(to.end(), missing, gap);
    to.insert(to.end(), from.begin(), from.end());
}

void append(RecordStretch& to, std::size_t missing, double step_s, const RecordStretch& from) {
    if (!to.raw.empty()) append(to.raw, missing, {kNaN, kNaN, kNaN, kNaN}, from.raw);
    for (std::size_t k = 0; k < to.axes_mgal.size(); ++k)
        append(to.axes_mgal[k], missing, kNaN, from.axes_mgal[k]);
    append(to.quantity, missing, kNaN, from.quantity);
    append(to.temperature_degc, missing, kNaN, from.temperature_degc);
    if (!to.outer_degc.empty() || !from.outer_degc.empty()) {
        to.outer_degc.resize(to.size(), kNaN);
        const double last = to.outer_degc.back();
        append(to.outer_degc, missing, last, from.outer_degc);
        to.outer_degc.resize(to.size() + missing + from.size(), kNaN);
    }
    for (; missing > 0; --missing) to.times.push_back(to.times.back() + from_seconds(step_s));
    to.times.insert(to.times.end(), from.times.begin(), from.times.end());
}

/// Returns the number of samples missing between two stretches of different parts; std::nullopt if
/// they cannot be joined.
std::optional<std::size_t> bridged(const Part& before, const Part& after, double step_s) {
    const RecordStretch &a = before.stretch, &b = after.stretch;
    if (before.number == after.number || a.serial_number != b.serial_number ||
        before.is_tide_removed != after.is_tide_removed || a.raw.empty() != b.raw.empty() ||
        a.axes_mgal.size() != b.axes_mgal.size())
        return std::nullopt;
    const double steps = std::round(seconds_between(a.times.back(), b.times.front()) / step_s);
    if (steps > static_cast<double>(kLongestBridge + 1)) return std::nullopt;
    return static_cast<std::size_t>(std::max(steps, 1.0)) - 1;
}

}  // namespace

LongRecord joined_record(std::vector<LongRecord> parts) {
    LongRecord all;
    all.raw_rate_hz = parts.front().raw_rate_hz;
    all.step_s = parts.front().step_s;
    all.data_sheet_mgal_per_sqrt_hz = parts.front().data_sheet_mgal_per_sqrt_hz;
    all.is_tide_removed = true;
    std::vector<Part> sorted;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        LongRecord& part = parts[k];
        if (std::abs(part.step_s / all.step_s - 1.0) > kSameStep)
            throw InputError(fmt::format(
                "{}: a sample every {} s, {} has one every {} s; allowed: one step in all parts of "
                "a record",
                part.source.string(), text::shortest(part.step_s), parts.front().source.string(),
                text::shortest(all.step_s)));
        all.is_tide_removed = all.is_tide_removed && part.is_tide_removed;
        for (RecordStretch& stretch : part.stretches)
            sorted.push_back({std::move(stretch), k, part.is_tide_removed});
        std::move(part.inputs.begin(), part.inputs.end(), std::back_inserter(all.inputs));
        std::move(part.warnings.begin(), part.warnings.end(), std::back_inserter(all.warnings));
    }
    const auto start_of = [](const Part& part) { return part.stretch.times.front(); };
    std::ranges::stable_sort(sorted, {}, start_of);
    std::vector<Part> joined;
    for (Part& next : sorted) {
        if (joined.empty()) {
            joined.push_back(std::move(next));
            continue;
        }
        Part& last = joined.back();
        if (next.number == last.number && start_of(next) <= last.stretch.times.back())
            throw InputError(fmt::format(
                "{}: instants from {} on occur twice, because the host's clock was set back; "
                "allowed: each instant once; correct the times with a351-correct retime",
                parts[next.number].source.string(), to_rfc3339(start_of(next))));
        if (start_of(next) <= last.stretch.times.back())
            throw InputError(fmt::format(
                "{}: at {} it overlaps {}; allowed: each instant in one part of a record",
                parts[next.number].source.string(), to_rfc3339(start_of(next)),
                parts[last.number].source.string()));
        if (const auto missing = bridged(last, next, all.step_s)) {
            if (last.stretch.outer_degc.empty() != next.stretch.outer_degc.empty())
                all.warnings.push_back(
                    text::message("a part of the record that begins or ends at {} lacks the "
                                  "temperature of the outer oven",
                                  to_rfc3339(start_of(next))));
            append(last.stretch, *missing, all.step_s, next.stretch);
            last.number = next.number;
            continue;
        }
        if (text::Message change = archive_series::sensor_change(last.stretch.serial_number,
                                                                 next.stretch.serial_number);
            last.number != next.number && !change.empty()) {
            all.warnings.push_back(text::message("from {} on, {}; the record is divided there",
                                                 to_rfc3339(start_of(next)), change));
            next.stretch.begins_with = std::move(change);
        }
        joined.push_back(std::move(next));
    }
    for (Part& part : joined) all.stretches.push_back(std::move(part.stretch));
    return all;
}

}  // namespace a351::corrector::long_record
