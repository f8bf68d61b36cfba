#include <cmath>

#include "corrector/fixed_point/record_result.hpp"
#include "corrector/survey/aligned_text.hpp"

namespace a351::corrector {
namespace {

constexpr double kSecondsPerHour = 3600.0;

std::string hours(std::size_t samples, double step_s) {
    return fixed(static_cast<double>(samples) * step_s / kSecondsPerHour, 2);
}

std::string segments_text(const RecordResult& result) {
    std::vector<std::vector<std::string>> rows{
        {"segment", "start_utc", "h", "bridged", "knocks", "begins with"}};
    for (std::size_t k = 0; k < result.parts.segments.size(); ++k) {
        const RecordSegment& segment = result.parts.segments[k];
        rows.push_back({std::to_string(k + 1) + (k == result.analysed ? " *" : ""),
                        to_rfc3339(segment.start), hours(segment.size(), result.record.step_s),
                        std::to_string(segment.bridged), std::to_string(segment.disturbed),
                        segment.begins_with});
    }
    std::string text = aligned(rows) + "* analysed\n";
    for (const RefusedPart& part : result.parts.refused) {
        text += "refused " + to_rfc3339(part.start) + " to " + to_rfc3339(part.end) + ": " +
                part.reason + '\n';
    }
    return text;
}

std::string limits(const Limits& value, int decimals) {
    return fixed(value.low, decimals) + " to " + fixed(value.high, decimals);
}

void add_points(std::vector<std::vector<std::string>>& rows, const std::string& way,
                const std::vector<ResponsePoint>& points) {
    for (const ResponsePoint& point : points) {
        if (!point.refusal.empty()) continue;
        rows.push_back({way, fixed(point.period_s, 0), fixed(point.gain.value, 0),
                        limits(point.gain, 0), fixed(point.phase_deg.value, 0),
                        limits(point.phase_deg, 0), fixed(point.coherence, 2)});
    }
}

/// Neighbouring bands that are refused for the same reason share a line.
std::string refusals_text(const std::string& way, const std::vector<ResponsePoint>& points) {
    std::string text;
    for (std::size_t first = 0; first < points.size();) {
        std::size_t last = first;
        while (last + 1 < points.size() && points[last + 1].refusal == points[first].refusal)
            ++last;
        if (!points[first].refusal.empty()) {
            text += way + ", " + fixed(points[first].shortest_s, 0) + " to " +
                    fixed(points[last].longest_s, 0) + " s: " + points[first].refusal +
                    "; needed: " + points[first].needed;
            if (last > first) text += " ... " + points[last].needed;
            text += '\n';
        }
        first = last + 1;
    }
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
        const CorrelationPeak &negative = pair.correlation.negative,
                              &positive = pair.correlation.positive;
        const std::string moved = ", sign turned, " + fixed(pair.shift_s, 0) + " s earlier";
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
             {key + "_peak_ratio", name + ": positive by negative peak", "", "about 1",
              std::abs(positive.value / negative.value), 3},
             {key + "_phase_deg", name + ": phase by both peaks", "deg", "-",
              phase_of_peaks_deg(pair), 0}});
    };
    add("band", "band", analysis.band);
    if (analysis.modes) add("mode", "modes", *analysis.modes);
    return list;
}

std::string record_text(const RecordResult& result) {
    std::string text = segments_text(result) + '\n';
    std::vector<std::vector<std::string>> rows{{"statistic", "value", "unit", "published"}};
    for (const RecordStatistic& statistic : record_statistics(result)) {
        rows.push_back({statistic.name, fixed(statistic.value, statistic.decimals), statistic.unit,
                        statistic.published});
    }
    text += aligned(rows);
    const RecordAnalysis& analysis = result.analysis;
    if (analysis.temperature_mode && analysis.acceleration_mode) {
        const ChosenMode &t = *analysis.temperature_mode, &a = *analysis.acceleration_mode;
        text += "modes: temperature " + std::to_string(t.number) + " of " +
                std::to_string(analysis.temperature.modes.size()) + " (" + fixed(t.period_s, 0) +
                " s), acceleration " + std::to_string(a.number) + " of " +
                std::to_string(analysis.acceleration.modes.size()) + " (" + fixed(a.period_s, 0) +
                " s)\n";
    }
    text += '\n' + causal_reading(analysis.band) + "\n\n";

    rows = {
        {"response", "period_s", "gain_mgal_per_degc", "95 %", "phase_deg", "95 %", "coherence"}};
    add_points(rows, "by spectrum", analysis.by_spectrum);
    add_points(rows, "by modes", analysis.by_modes);
    text += aligned(rows) + refusals_text("by spectrum", analysis.by_spectrum) +
            refusals_text("by modes", analysis.by_modes) + '\n';
    for (const std::string& remark : analysis.remarks) text += remark + '\n';
    return text;
}

}  // namespace a351::corrector
