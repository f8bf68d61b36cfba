#include "corrector/model/row_doubts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
std::string doubts_text(const SurveyCorrection& result) {
    std::string text;
    for (const CorrectedRow& row : result.rows) {
        if (row.doubt_physical.empty()) continue;
        text +=
            fmt::format("  {} ({}): {}\n", row.row.site, row.row.occupation, row.doubt_physical);
    }
    if (text.empty()) return "doubtful readings: none\n";
    return "doubtful readings (none is left out because of this):\n" + text;
}

text::Message temperature_remark(const std::vector<CorrectedRow>& rows,
                                 const std::vector<std::string>& datum) {
    if (rows.empty() || !rows.front().row.has_temperature) return {};
    double low_degc = HUGE_VAL, high_degc = -HUGE_VAL;
    for (const CorrectedRow& row : rows) {
        if (!row.is_used || !row.row.is_datum(datum)) continue;
        low_degc = std::min(low_degc, row.row.temperature.value());
        high_degc = std::max(high_degc, row.row.temperature.value());
    }
    if (low_degc > high_degc) return {};
    double most_degc = 0.0;
    std::vector<std::string> names;
    for (const CorrectedRow& row : rows) {
        if (row.row.is_excluded || row.row.is_datum(datum)) continue;
        const double degc = row.row.temperature.value();
        const double outside_degc = std::max(low_degc - degc, degc - high_degc);
        if (outside_degc <= kOutsideTemperature_degc) continue;
        most_degc = std::max(most_degc, outside_degc);
        names.push_back(fmt::format("{} ({})", row.row.site, row.row.occupation));
    }
    if (names.empty()) return {};
    return text::message(
        "temperature outside {} to {} degC, that of the known stations in the fit, by up to {} "
        "degC: the temperature correction is extrapolated for {}",
        text::fixed(low_degc, 2), text::fixed(high_degc, 2), text::fixed(most_degc, 2),
        text::joined(names));
}

}  // namespace a351::corrector::model
