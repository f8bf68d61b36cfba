#include "corrector/judgement/closure.hpp"

#include <cmath>

#include "protocol/core/units.hpp"

namespace a351::corrector::judgement {
namespace {

Closure close_pair(const std::vector<model::CorrectedRow>& rows, std::size_t earlier,
                   std::size_t later) {
    const model::CorrectedRow& a = rows[earlier];
    const model::CorrectedRow& b = rows[later];
    Closure pair;
    pair.earlier = earlier;
    pair.later = later;
    pair.hours = seconds_between(a.row.time, b.row.time) / kSecondsPerHour;
    pair.before = b.row.acceleration - a.row.acceleration;
    pair.after_tide = pair.before - (b.row.tide - a.row.tide);
    pair.after_temperature =
        pair.after_tide + (b.temperature_correction - a.temperature_correction);
    pair.after_rate = pair.after_temperature + (b.rate_correction - a.rate_correction) +
                      (b.tilt_correction_or_zero() - a.tilt_correction_or_zero());
    pair.after_all = b.corrected - a.corrected;
    if (a.row.occupation != b.row.occupation)
        pair.drift_mgal_per_h = pair.after_rate.value() / pair.hours;
    return pair;
}

}  // namespace

std::vector<Closure> close_stations(const model::SurveyCorrection& result) {
    const std::vector<model::CorrectedRow>& rows = result.rows;
    std::vector<Closure> closures;
    for (const model::StationValue& station : result.stations) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].row.site != station.site) continue;
            for (std::size_t j = i + 1; j < rows.size(); ++j) {
                if (rows[j].row.site == station.site) closures.push_back(close_pair(rows, i, j));
            }
        }
    }
    return closures;
}

MilliGal rms_of(const std::vector<Closure>& closures, MilliGal Closure::*difference) {
    double sum = 0.0;
    for (const Closure& pair : closures) {
        const double value = (pair.*difference).value();
        sum += value * value;
    }
    return MilliGal(std::sqrt(sum / static_cast<double>(closures.size())));
}

}  // namespace a351::corrector::judgement
