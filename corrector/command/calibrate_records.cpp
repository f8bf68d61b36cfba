#include "corrector/command/calibrate_records.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "corrector/command/record_input.hpp"
#include "corrector/long_record/joined_record.hpp"
#include "corrector/long_record/record_calibration.hpp"
#include "corrector/long_record/record_tables.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/unit/calibration_origin.hpp"

namespace a351::corrector::command {
namespace {

// Longest time from power-on to the first sample, over which the warm-up is extrapolated.
constexpr double kLatestBegin_h = 0.5;
// Five lags of the slow path: the fit assumes equilibrium at its start.
constexpr double kSettled_h = 4.0;
constexpr double kContradiction = 0.01;
constexpr double kCycle_s = 900.0;  // usual cycle of the oven, for the bands of the residual test

/// Returns the time from power-on to the start of the segment, if it is at most kLatestBegin_h.
std::optional<double> begins_after_h(const long_record::RecordSegment& segment,
                                     const std::optional<UtcTime>& power_on) {
    if (!power_on) return std::nullopt;
    const double hours = seconds_between(*power_on, segment.start) / kSecondsPerHour;
    return hours >= 0.0 && hours <= kLatestBegin_h ? std::optional(hours) : std::nullopt;
}

/// Removes the first hours of a segment, in which the unit is not in equilibrium after power-on.
long_record::RecordSegment without_begin(long_record::RecordSegment segment, double step_s) {
    const auto cut =
        std::min(segment.size(), static_cast<std::size_t>(kSettled_h * kSecondsPerHour / step_s));
    const auto end = static_cast<std::ptrdiff_t>(cut);
    segment.quantity.erase(segment.quantity.begin(), segment.quantity.begin() + end);
    segment.temperature_degc.erase(segment.temperature_degc.begin(),
                                   segment.temperature_degc.begin() + end);
    if (!segment.outer_degc.empty())
        segment.outer_degc.erase(segment.outer_degc.begin(), segment.outer_degc.begin() + end);
    segment.start = segment.start + from_seconds(static_cast<double>(cut) * step_s);
    return segment;
}

long_record::TwoPathFit fitted(const long_record::RecordSegment& segment, double step_s) {
    return long_record::fit_two_paths(segment.temperature_degc, segment.quantity, step_s, kCycle_s,
                                      segment.outer_degc);
}

/// @throws InputError  the record is of several units.
std::string unit_of(const long_record::LongRecord& record, const std::string& file) {
    const std::string& unit = record.stretches.front().serial_number;
    const auto other = std::ranges::find_if(
        record.stretches,
        [&](const long_record::RecordStretch& stretch) { return stretch.serial_number != unit; });
    if (other == record.stretches.end()) return unit;
    throw InputError(fmt::format("{}: from {} on of unit '{}', before of '{}'; allowed: one unit",
                                 file, to_rfc3339(other->times.front()), other->serial_number,
                                 unit));
}

std::string value_text(const long_record::FittedParameter& parameter) {
    return fmt::format("{}: {} +- {} {}", parameter.name, text::fixed(parameter.value, 1),
                       text::fixed(parameter.standard_error, 1), parameter.unit);
}

std::string thermal_text(const long_record::PooledThermal& pooled) {
    std::string text;
    for (const long_record::FittedParameter& parameter : pooled.parameters) {
        text += fmt::format("  {}{}\n", value_text(parameter),
                            parameter.is_determined
                                ? ""
                                : "; not determined, needed: " + parameter.needed.english());
    }
    text +=
        fmt::format("  static slope, both paths: {} +- {} mGal/degC{}\n",
                    text::fixed(pooled.static_slope, 1), text::fixed(pooled.static_slope_error, 1),
                    pooled.is_static_slope_determined ? "" : "; not determined");
    if (pooled.agreement_p < kContradiction)
        text +=
            "  the records contradict each other (probability of chance below 1 %). The unit may "
            "have changed: calibrate from each record alone\n";
    return text;
}

std::string refusal(const long_record::PooledThermal& pooled, const std::string& file) {
    std::string message = file + ": the response to temperature is not determined";
    for (const long_record::FittedParameter& parameter : pooled.parameters)
        if (!parameter.needed.empty())
            message += fmt::format("; {}, needed: {}", value_text(parameter), parameter.needed);
    return message;
}

}  // namespace

std::string calibrate_from_records(unit::Calibration& calibration,
                                   const RecordCalibrationOptions& options) {
    const long_record::LongRecord record =
        long_record::joined_record(read_records(options.files, {}));
    const std::string& file = options.files.front();
    unit::note_origin(calibration, unit_of(record, file), record.stretches.front().times.front(),
                      record.inputs, file);
    const long_record::RecordSegments parts = divide_or_refuse(record, {}, file);
    const double within_mgal = options.within_mgal.value_or(unit::WarmUpGuidance{}.within_mgal);
    long_record::WarmUpReading warm_up{
        std::nullopt,
        "no warm-up guidance: needed: a record that begins at most half an hour "
        "after the sensor was switched on, with --power-on"};
    std::string text;
    for (const std::string& line : long_record::refused_parts(parts)) text += line + '\n';
    std::vector<long_record::TwoPathFit> fits;
    std::vector<std::string> lacks;
    for (long_record::RecordSegment segment : parts.segments) {
        if (const auto begin_h = begins_after_h(segment, options.power_on)) {
            // The warm-up of an outer oven is a part of what the operator waits for.
            long_record::RecordSegment whole = segment;
            whole.outer_degc.clear();
            warm_up = long_record::warm_up_guidance(fitted(whole, record.step_s), *begin_h,
                                                    segment.hours(record.step_s), within_mgal);
            segment = without_begin(std::move(segment), record.step_s);
        }
        const std::string name =
            fmt::format("{} h from {}", text::fixed(segment.hours(record.step_s), 1),
                        to_rfc3339(segment.start));
        const std::string lack =
            segment.size() < long_record::SegmentOptions{}.shortest
                ? fmt::format(
                      "too short for the response to temperature; needed: 3 h that begin "
                      "{} h after power-on or later",
                      text::fixed(kSettled_h, 0))
                : long_record::reason_against_two_paths(segment.temperature_degc, segment.quantity,
                                                        record.step_s);
        if (!lack.empty()) {
            lacks.push_back(fmt::format("{}: {}", name, lack));
            text += lacks.back() + '\n';
            continue;
        }
        fits.push_back(fitted(segment, record.step_s));
        text += fmt::format("{}, residual {} mGal{}\n", name,
                            text::fixed(fits.back().residual_rms_mgal, 2),
                            fits.back().unexplained.empty()
                                ? ""
                                : ", which still depends on the temperature: the model does not "
                                  "describe all of it");
    }
    if (fits.empty()) throw InputError(fmt::format("{}: {}", file, lacks.front()));
    const long_record::PooledThermal pooled = long_record::pool_thermal(fits);
    if (!pooled.response) throw InputError(refusal(pooled, file));
    if (options.within_mgal && !warm_up.guidance)
        throw InputError(
            fmt::format("--within = {}: {}", text::fixed(within_mgal, 3), warm_up.words));
    calibration.thermal = pooled.response;
    calibration.warm_up = warm_up.guidance;
    return fmt::format("{}{}  {}\n", text, thermal_text(pooled), warm_up.words);
}

}  // namespace a351::corrector::command
