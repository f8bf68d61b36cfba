#include <cmath>

#include "corrector/long_record/applied_tables.hpp"
#include "corrector/long_record/record_result.hpp"
#include "corrector/long_record/record_tables.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

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
        const CorrelationPeak &negative = pair.correlation.negative,
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
            two_paths_reading(result) + "\n\n";
    return text + applied_text(result) + lines_of(analysis.remarks);
}

}  // namespace a351::corrector
