#include "corrector/long_record/record_tables.hpp"

#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

std::string limits(const Limits& value) {
    return text::fixed(value.low, 0) + " to " + text::fixed(value.high, 0);
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
            std::string line = way + ", " + text::fixed(points[first].shortest_s, 0) + " to " +
                               text::fixed(points[last].longest_s, 0) +
                               " s: " + points[first].refusal + "; needed: " + points[first].needed;
            if (last > first) line += " ... " + points[last].needed;
            lines.push_back(std::move(line));
        }
        first = last + 1;
    }
}

}  // namespace

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
    for (const RecordStatistic& statistic : record_statistics(result)) {
        rows.push_back({statistic.name, text::fixed(statistic.value, statistic.decimals),
                        statistic.unit, statistic.published});
    }
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

std::vector<std::string> refused_parts(const RecordResult& result) {
    std::vector<std::string> lines;
    for (const RefusedPart& part : result.parts.refused) {
        lines.push_back("refused " + to_rfc3339(part.start) + " to " + to_rfc3339(part.end) + ": " +
                        part.reason);
    }
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
    return "modes: temperature " + std::to_string(t.number) + " of " +
           std::to_string(analysis.temperature.modes.size()) + " (" + text::fixed(t.period_s, 0) +
           " s), acceleration " + std::to_string(a.number) + " of " +
           std::to_string(analysis.acceleration.modes.size()) + " (" + text::fixed(a.period_s, 0) +
           " s)";
}

std::string two_paths_reading(const RecordResult& result) {
    const TwoPathFit& fit = result.analysis.two_paths;
    std::string text = "static slope, both paths: " + text::fixed(fit.static_slope, 1) + " +- " +
                       text::fixed(fit.static_slope_error, 1) + " mGal/degC" +
                       (fit.is_static_slope_determined
                            ? ""
                            : ", not determined (needed: " + fit[TwoPathTerm::slow].needed + ")") +
                       "; residual " + text::fixed(fit.residual_rms_mgal, 2) + " mGal rms; ";
    if (fit.unexplained.empty()) return text + "it does not follow the temperature in any band";
    text += "it still follows the temperature at";
    for (const ResponsePoint& point : fit.unexplained)
        text += " " + text::fixed(point.period_s, 0) + " s";
    return text + ": the model is not enough, do not extrapolate it";
}

}  // namespace a351::corrector
