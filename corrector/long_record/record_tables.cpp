#include "corrector/long_record/record_tables.hpp"

#include <fmt/core.h>

#include <cmath>

#include "corrector/long_record/applied_tables.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::long_record {
namespace {

std::string limits(const Limits& value) {
    return fmt::format("{} to {}", text::fixed(value.low, 0), text::fixed(value.high, 0));
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
            lines.push_back(fmt::format("{}, {} to {} s: {}; needed: {}", way,
                                        text::fixed(points[first].shortest_s, 0),
                                        text::fixed(points[last].longest_s, 0),
                                        points[first].refusal, points[first].needed));
            if (last > first) lines.back() += " ... " + points[last].needed;
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
        {"raw_slope_mgal_per_degc", "raw slope", "mGal/degC", "131.82", analysis.raw.slope, 2},
        {"raw_slope_error_mgal_per_degc", "raw slope, standard error", "mGal/degC", "-",
         analysis.raw.slope_error, 2},
        {"raw_r2", "raw R2", "", "0.265", analysis.raw.r2, 3},
        {"trend_slope_mgal_per_degc", "slope of the residues", "mGal/degC", "positive",
         analysis.trend.slope, 1},
        {"trend_temperature_change_degc", "change of the temperature's residue", "degC", "falls",
         analysis.temperature_change_degc, 4},
        {"trend_acceleration_change_mgal", "change of the acceleration's residue", "mGal", "falls",
         analysis.acceleration_change_mgal, 2}};
    const auto add = [&list](const std::string& key, const std::string& name,
                             const PairStatistics& pair) {
        const correlation::CorrelationPeak &negative = pair.correlation.negative,
                                           &positive = pair.correlation.positive;
        const std::string moved = ", sign inverted, " + text::fixed(pair.shift_s, 0) + " s earlier";
        list.insert(
            list.end(),
            {{key + "_period_s", name + ": period of the temperature", "s", "600-900",
              pair.period_s, 0},
             {key + "_temperature_swing_degc", name + ": temperature swing", "degC", "0.02",
              pair.temperature_swing_degc, 4},
             {key + "_acceleration_swing_mgal", name + ": acceleration swing", "mGal", "6",
              pair.acceleration_swing_mgal, 2},
             {key + "_slope_mgal_per_degc", name + ": slope" + moved, "mGal/degC", "256.89",
              pair.moved.slope, 2},
             {key + "_slope_error_mgal_per_degc", name + ": its standard error", "mGal/degC", "-",
              pair.moved.slope_error, 2},
             {key + "_r2", name + ": R2" + moved, "", "0.464", pair.moved.r2, 3},
             {key + "_negative_delay_s", name + ": delay of the negative peak", "s", "240-280",
              negative.delay_s, 0},
             {key + "_negative_peak", name + ": its correlation", "", "-", negative.value, 3},
             {key + "_positive_delay_s", name + ": delay of the positive peak", "s", "other side",
              positive.delay_s, 0},
             {key + "_positive_peak", name + ": its correlation", "", "-", positive.value, 3},
             {key + "_peak_ratio", name + ": ratio of positive to negative peak", "", "about 1",
              std::abs(positive.value / negative.value), 3},
             {key + "_phase_deg", name + ": phase by both peaks", "deg", "-",
              phase_of_peaks_deg(pair), 0}});
    };
    add("band", "band", analysis.band);
    if (analysis.modes) add("mode", "modes", *analysis.modes);
    return list;
}

std::string record_text(const RecordResult& result) {
    const RecordAnalysis& analysis = result.analysis;
    std::string text = text::aligned(segments_table(result)) + "* analysed\n" +
                       lines_of(refused_parts(result)) + '\n' +
                       text::aligned(statistics_table(result));
    if (const std::string modes = chosen_modes(result); !modes.empty()) text += modes + '\n';
    text += '\n' + analysis.reading + "\n\n" + text::aligned(response_table(result)) +
            lines_of(refused_bands(result)) + '\n' + text::aligned(two_paths_table(result)) +
            two_paths_reading(result) + "\n\n" + text::aligned(noise_table(result)) +
            noise_reading(result) + "\n\n";
    return text + applied_text(result) + lines_of(analysis.remarks);
}

TextTable segments_table(const RecordResult& result) {
    TextTable rows{{"segment", "start_utc", "h", "bridged", "knocks", "begins with"}};
    for (std::size_t k = 0; k < result.parts.segments.size(); ++k) {
        const RecordSegment& segment = result.parts.segments[k];
        rows.push_back(
            {std::to_string(k + 1) + (k == result.analysed ? " *" : ""), to_rfc3339(segment.start),
             text::fixed(
                 static_cast<double>(segment.size()) * result.record.step_s / kSecondsPerHour, 2),
             std::to_string(segment.bridged), std::to_string(segment.disturbed),
             segment.begins_with});
    }
    return rows;
}

TextTable statistics_table(const RecordResult& result) {
    TextTable rows{{"statistic", "value", "unit", "published"}};
    for (const RecordStatistic& statistic : record_statistics(result))
        rows.push_back({statistic.name, text::fixed(statistic.value, statistic.decimals),
                        statistic.unit, statistic.published});
    return rows;
}

TextTable response_table(const RecordResult& result) {
    TextTable rows{
        {"response", "period_s", "gain_mgal_per_degc", "95 %", "phase_deg", "95 %", "coherence"}};
    add_points(rows, "by spectrum", result.analysis.by_spectrum);
    add_points(rows, "by modes", result.analysis.by_modes);
    return rows;
}

TextTable two_paths_table(const RecordResult& result) {
    TextTable rows{{"two paths", "value", "standard error", "unit", "needed to determine it"}};
    for (const FittedParameter& parameter : result.analysis.two_paths.parameters) {
        const int decimals = parameter.unit == "s" ? 0 : parameter.unit == "mGal/h" ? 4 : 2;
        rows.push_back({parameter.name, text::fixed(parameter.value, decimals),
                        text::fixed(parameter.standard_error, decimals), parameter.unit,
                        parameter.is_determined ? "" : parameter.needed});
    }
    return rows;
}

TextTable noise_table(const RecordResult& result) {
    TextTable rows{{"averages of s", "Allan deviation mGal", "by the noise model"}};
    for (const AllanDeviation& point : result.analysis.noise.allan)
        rows.push_back({text::fixed(point.averaging_s, 0), text::fixed(point.deviation_mgal, 3),
                        text::fixed(point.model_mgal, 3)});
    return rows;
}

std::string noise_reading(const RecordResult& result) {
    const RecordNoise& noise = result.analysis.noise;
    std::string text = fmt::format(
        "Noise: white {} mGal in 1 s, flicker {} mGal, random walk {} mGal in 1 h. How long to "
        "stay: ",
        text::fixed(noise.white_mgal_sqrt_s, 2), text::fixed(noise.flicker_mgal, 3),
        text::fixed(noise.walk_mgal_per_sqrt_s * std::sqrt(kSecondsPerHour), 3));
    if (!noise.useful) return text + "not known; needed: a record of 3 h";
    const bool is_longest = noise.useful->averaging_s >= noise.stays.back().averaging_s;
    return text + fmt::format(
                      "averages 1 h apart scatter by {} mGal over {} s, and by {} mGal over "
                      "{} s; {}",
                      text::fixed(noise.stays.front().scatter_mgal, 2),
                      text::fixed(noise.stays.front().averaging_s, 0),
                      text::fixed(noise.useful->scatter_mgal, 2),
                      text::fixed(noise.useful->averaging_s, 0),
                      is_longest ? "longer stays were not compared"
                                 : "a longer stay gains less than a tenth");
}

std::vector<std::string> refused_parts(const RecordResult& result) {
    std::vector<std::string> lines;
    for (const RefusedPart& part : result.parts.refused)
        lines.push_back(fmt::format("refused {} to {}: {}", to_rfc3339(part.start),
                                    to_rfc3339(part.end), part.reason));
    return lines;
}

std::vector<std::string> refused_bands(const RecordResult& result) {
    std::vector<std::string> lines;
    add_refusals(lines, "by spectrum", result.analysis.by_spectrum);
    add_refusals(lines, "by modes", result.analysis.by_modes);
    return lines;
}

std::string chosen_modes(const RecordResult& result) {
    const RecordAnalysis& analysis = result.analysis;
    if (!analysis.temperature_mode || !analysis.acceleration_mode) return {};
    const ChosenMode &t = *analysis.temperature_mode, &a = *analysis.acceleration_mode;
    return fmt::format("modes: temperature {} of {} ({} s), acceleration {} of {} ({} s)", t.number,
                       analysis.temperature.modes.size(), text::fixed(t.period_s, 0), a.number,
                       analysis.acceleration.modes.size(), text::fixed(a.period_s, 0));
}

std::string two_paths_reading(const RecordResult& result) {
    const TwoPathFit& fit = result.analysis.two_paths;
    std::string text = fmt::format(
        "static slope, both paths: {} +- {} mGal/degC{}; residual {} mGal rms; ",
        text::fixed(fit.static_slope, 1), text::fixed(fit.static_slope_error, 1),
        fit.is_static_slope_determined
            ? ""
            : fmt::format(", not determined (needed: {})", fit[TwoPathTerm::slow].needed),
        text::fixed(fit.residual_rms_mgal, 2));
    if (fit.unexplained.empty()) return text + "it does not follow the temperature in any band";
    text += "it still follows the temperature at";
    for (const ResponsePoint& point : fit.unexplained)
        text += fmt::format(" {} s", text::fixed(point.period_s, 0));
    return text + ": the model is not enough, do not extrapolate it";
}

}  // namespace a351::corrector::long_record
