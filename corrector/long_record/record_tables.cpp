#include "corrector/long_record/record_tables.hpp"

#include <fmt/core.h>

#include <cmath>

#include "corrector/long_record/applied_tables.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::long_record {
namespace {

std::string limits(const Limits& value) {
    return text::tr("{} to {}", text::fixed(value.low, 0), text::fixed(value.high, 0));
}

void add_points(TextTable& rows, const std::string& way, const std::vector<ResponsePoint>& points) {
    for (const ResponsePoint& point : points) {
        if (!point.refusal.empty()) continue;
        rows.push_back({way, text::fixed(point.period_s, 0), text::fixed(point.gain.value, 0),
                        limits(point.gain), text::fixed(point.phase_deg.value, 0),
                        limits(point.phase_deg), text::fixed(point.coherence, 2)});
    }
}

void add_refusals(std::vector<std::string>& lines, const std::string& way,
                  const std::vector<ResponsePoint>& points) {
    for (std::size_t first = 0; first < points.size();) {
        std::size_t last = first;
        while (last + 1 < points.size() && points[last + 1].refusal == points[first].refusal)
            ++last;
        if (!points[first].refusal.empty()) {
            lines.push_back(text::tr(
                "{}, {} to {} s: {}; needed: {}{}", text::Message(way),
                text::fixed(points[first].shortest_s, 0), text::fixed(points[last].longest_s, 0),
                points[first].refusal, points[first].needed,
                last > first ? text::Message(" ... ") + points[last].needed : text::Message()));
        }
        first = last + 1;
    }
}

std::string lines_of(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    return text;
}

}  // namespace

std::vector<RecordStatistic> record_statistics(const RecordResult& result) {
    const RecordAnalysis& analysis = result.analysis;
    std::vector<RecordStatistic> list{
        {"raw_slope_mgal_per_degc", text::tr("raw slope"), "mGal/degC", "131.82",
         analysis.raw.slope, 2},
        {"raw_slope_error_mgal_per_degc", text::tr("raw slope, standard error"), "mGal/degC", "-",
         analysis.raw.slope_error, 2},
        {"raw_r2", text::tr("raw R2"), "", "0.265", analysis.raw.r2, 3},
        {"trend_slope_mgal_per_degc", text::tr("slope of the residues"), "mGal/degC",
         text::tr("positive"), analysis.trend.slope, 1},
        {"trend_temperature_change_degc", text::tr("change of the temperature's residue"), "degC",
         text::tr("falls"), analysis.temperature_change_degc, 4},
        {"trend_acceleration_change_mgal", text::tr("change of the acceleration's residue"), "mGal",
         text::tr("falls"), analysis.acceleration_change_mgal, 2}};
    const auto add = [&list](const std::string& key, const std::string& name,
                             const PairStatistics& pair) {
        const signal::CorrelationPeak &negative = pair.correlation.negative,
                                      &positive = pair.correlation.positive;
        const std::string shift = text::fixed(pair.shift_s, 0);
        list.insert(list.end(),
                    {{key + "_period_s", text::tr("{}: period of the temperature", name), "s",
                      "600-900", pair.period_s, 0},
                     {key + "_temperature_swing_degc", text::tr("{}: temperature swing", name),
                      "degC", "0.02", pair.temperature_swing_degc, 4},
                     {key + "_acceleration_swing_mgal", text::tr("{}: acceleration swing", name),
                      "mGal", "6", pair.acceleration_swing_mgal, 2},
                     {key + "_slope_mgal_per_degc",
                      text::tr("{}: slope, sign inverted, {} s earlier", name, shift), "mGal/degC",
                      "256.89", pair.moved.slope, 2},
                     {key + "_slope_error_mgal_per_degc", text::tr("{}: its standard error", name),
                      "mGal/degC", "-", pair.moved.slope_error, 2},
                     {key + "_r2", text::tr("{}: R2, sign inverted, {} s earlier", name, shift), "",
                      "0.464", pair.moved.r2, 3},
                     {key + "_negative_delay_s", text::tr("{}: delay of the negative peak", name),
                      "s", "240-280", negative.delay_s, 0},
                     {key + "_negative_peak", text::tr("{}: its correlation", name), "", "-",
                      negative.value, 3},
                     {key + "_positive_delay_s", text::tr("{}: delay of the positive peak", name),
                      "s", text::tr("other side"), positive.delay_s, 0},
                     {key + "_positive_peak", text::tr("{}: its correlation", name), "", "-",
                      positive.value, 3},
                     {key + "_peak_ratio", text::tr("{}: ratio of positive to negative peak", name),
                      "", text::tr("about 1"), std::abs(positive.value / negative.value), 3},
                     {key + "_phase_deg", text::tr("{}: phase by both peaks", name), "deg", "-",
                      phase_of_peaks_deg(pair), 0}});
    };
    add("band", text::tr("band"), analysis.band);
    if (analysis.modes) add("mode", text::tr("modes"), *analysis.modes);
    return list;
}

std::string record_text(const RecordResult& result) {
    const std::string parts = lines_of(refused_parts(result.parts)) + '\n';
    if (result.tilt)
        return text::aligned(segments_table(result)) + parts + tilt_reading(result) + '\n';
    const RecordAnalysis& analysis = result.analysis;
    std::string text = text::aligned(segments_table(result)) + text::tr("* analysed") + "\n" +
                       parts + text::aligned(statistics_table(result));
    if (const std::string modes = chosen_modes(result); !modes.empty()) text += modes + '\n';
    text += '\n' + text::in_words(analysis.reading) + "\n\n" +
            text::aligned(response_table(result)) + lines_of(refused_bands(result)) + '\n' +
            text::aligned(two_paths_table(result)) + two_paths_reading(result) + "\n\n" +
            text::aligned(noise_table(result)) + noise_reading(result) + "\n\n";
    return text + applied_text(result) + lines_of(text::each_in_words(analysis.remarks));
}

TextTable segments_table(const RecordResult& result) {
    TextTable rows{{text::tr("segment"), "start_utc", "h", text::tr("bridged"), text::tr("knocks"),
                    text::tr("begins with")}};
    for (std::size_t k = 0; k < result.parts.segments.size(); ++k) {
        const RecordSegment& segment = result.parts.segments[k];
        rows.push_back({std::to_string(k + 1) + (k == result.analysed && !result.tilt ? " *" : ""),
                        to_rfc3339(segment.start),
                        text::fixed(segment.hours(result.record.step_s), 2),
                        std::to_string(segment.bridged), std::to_string(segment.disturbed),
                        text::in_words(segment.begins_with)});
    }
    return rows;
}

TextTable statistics_table(const RecordResult& result) {
    TextTable rows{
        {text::tr("statistic"), text::tr("value"), text::tr("unit"), text::tr("published")}};
    for (const RecordStatistic& statistic : record_statistics(result))
        rows.push_back({statistic.name, text::fixed(statistic.value, statistic.decimals),
                        statistic.unit, statistic.published});
    return rows;
}

TextTable response_table(const RecordResult& result) {
    TextTable rows{{text::tr("response"), "period_s", "gain_mgal_per_degc", "95 %", "phase_deg",
                    "95 %", text::tr("coherence")}};
    add_points(rows, text::tr("by spectrum"), result.analysis.by_spectrum);
    add_points(rows, text::tr("by modes"), result.analysis.by_modes);
    return rows;
}

TextTable two_paths_table(const RecordResult& result) {
    TextTable rows{{text::tr("two paths"), text::tr("value"), text::tr("standard error"),
                    text::tr("unit"), text::tr("needed to determine it")}};
    const TwoPathFit& fit = result.analysis.two_paths;
    for (const FittedParameter& parameter : fit.parameters) {
        const int decimals = parameter.unit == "s" ? 0 : parameter.unit == "mGal/h" ? 4 : 2;
        rows.push_back({text::in_words(text::marked_message(parameter.name)),
                        text::fixed(parameter.value, decimals),
                        text::fixed(parameter.standard_error, decimals), parameter.unit,
                        text::in_words(parameter.needed)});
    }
    return rows;
}

TextTable noise_table(const RecordResult& result) {
    TextTable rows{{text::tr("averages of s"), text::tr("Allan deviation mGal"), text::tr("95 %"),
                    text::tr("by the noise model")}};
    for (const noise::AllanPoint& point : result.analysis.noise.allan.points)
        rows.push_back({text::fixed(point.averaging_s, 0),
                        text::fixed(point.deviation_mgal.value, 3),
                        result.analysis.noise.allan.noises.describes_record
                            ? text::tr("{} to {}", text::fixed(point.deviation_mgal.low, 3),
                                       text::fixed(point.deviation_mgal.high, 3))
                            : "-",
                        text::fixed(point.model_mgal, 3)});
    return rows;
}

std::string noise_reading(const RecordResult& result) {
    const noise::RecordNoise& noise = result.analysis.noise;
    const noise::ThreeNoises& levels = noise.allan.noises;
    const auto level = [&levels](const Limits& limits, double unit, int digits) {
        const std::string value = text::fixed(unit * limits.value, digits);
        if (!levels.describes_record) return text::Message(value);
        if (std::isinf(limits.high))
            return text::message("{} (from {}, no upper limit)", value,
                                 text::fixed(unit * limits.low, digits));
        return text::message("{} ({} to {})", value, text::fixed(unit * limits.low, digits),
                             text::fixed(unit * limits.high, digits));
    };
    const auto with_noise = [&](const text::Message& stay) {
        return text::tr(
            "Noise{}: white {} mGal in 1 s, flicker {} mGal, random walk {} mGal in 1 h. How long "
            "to stay: {}",
            levels.describes_record
                ? text::message(", with 95 % limits")
                : text::message(
                      ", only the nearest one, because a cycle or something else is in the record"),
            level(levels.white_mgal_sqrt_s, 1.0, 2), level(levels.flicker_mgal, 1.0, 3),
            level(levels.walk_mgal_per_sqrt_s, std::sqrt(kSecondsPerHour), 3), stay);
    };
    if (!noise.useful) return with_noise(text::message("not known; needed: a record of 3 h"));
    const bool is_longest = noise.useful->averaging_s >= noise.stays.back().averaging_s;
    return with_noise(text::message(
        "averages 1 h apart scatter by {} mGal over {} s, and by {} mGal over {} s; {}",
        text::fixed(noise.stays.front().scatter_mgal, 2),
        text::fixed(noise.stays.front().averaging_s, 0), text::fixed(noise.useful->scatter_mgal, 2),
        text::fixed(noise.useful->averaging_s, 0),
        is_longest ? text::message("longer stays were not compared")
                   : text::message("a longer stay gains less than a tenth")));
}

std::string tilt_reading(const RecordResult& result) {
    const TiltFit& tilt = *result.tilt;
    return text::tr(
        "Tilt of the axis {}: {} +- {} urad/degC, beside a straight line over time in each of {} "
        "segments; corrected to {} degC. A sample of {} s scatters by {} urad. The constant bias "
        "of "
        "the axis is in the tilt, so that only changes have a meaning.",
        tilt.axis == 0 ? "x" : "y", text::fixed(tilt.slope_urad_per_degc, 2),
        text::fixed(tilt.slope_error_urad_per_degc, 2), result.parts.segments.size(),
        text::fixed(tilt.temperature_degc, 3), text::fixed(result.record.step_s, 0),
        text::fixed(tilt.noise.points.front().deviation_mgal.value, 2));
}

std::vector<std::string> refused_parts(const RecordSegments& parts) {
    std::vector<std::string> lines;
    for (const RefusedPart& part : parts.refused)
        lines.push_back(text::tr("refused {} to {}: {}", to_rfc3339(part.start),
                                 to_rfc3339(part.end), part.reason));
    return lines;
}

std::vector<std::string> refused_bands(const RecordResult& result) {
    std::vector<std::string> lines;
    add_refusals(lines, text::tr("by spectrum"), result.analysis.by_spectrum);
    add_refusals(lines, text::tr("by modes"), result.analysis.by_modes);
    return lines;
}

std::string chosen_modes(const RecordResult& result) {
    const RecordAnalysis& analysis = result.analysis;
    if (!analysis.temperature_mode || !analysis.acceleration_mode) return {};
    const ChosenMode &t = *analysis.temperature_mode, &a = *analysis.acceleration_mode;
    return text::tr("modes: temperature {} of {} ({} s), acceleration {} of {} ({} s)", t.number,
                    analysis.temperature.modes.size(), text::fixed(t.period_s, 0), a.number,
                    analysis.acceleration.modes.size(), text::fixed(a.period_s, 0));
}

std::string two_paths_reading(const RecordResult& result) {
    const TwoPathFit& fit = result.analysis.two_paths;
    const std::string not_determined =
        fit.is_static_slope_determined
            ? ""
            : text::tr(", not determined (needed: {})", fit[TwoPathTerm::slow].needed);
    std::string periods;
    for (const ResponsePoint& point : fit.unexplained)
        periods +=
            fmt::format("{}{} s", periods.empty() ? "" : " ", text::fixed(point.period_s, 0));
    return text::tr("static slope, both paths: {} +- {} mGal/degC{}; residual {} mGal rms; {}",
                    text::fixed(fit.static_slope, 1), text::fixed(fit.static_slope_error, 1),
                    text::Message(not_determined), text::fixed(fit.residual_rms_mgal, 2),
                    periods.empty()
                        ? text::message("it does not follow the temperature in any band")
                        : text::message("it still follows the temperature at {}: the model is not "
                                        "enough, do not extrapolate it",
                                        periods));
}

}  // namespace a351::corrector::long_record
