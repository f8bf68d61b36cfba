#include "corrector/model/corrected_row.hpp"

#include <algorithm>

namespace a351::corrector::model {

void CorrectedRow::subtract(adjustment::Correction correction, MilliGal effect) {
    switch (correction) {
        case adjustment::Correction::temperature:
            temperature_correction = temperature_correction - effect;
            break;
        case adjustment::Correction::rate:
            rate_correction = rate_correction - effect;
            break;
        case adjustment::Correction::drift:
            drift_correction = drift_correction - effect;
            break;
        case adjustment::Correction::tilt:
            tilt_correction = tilt_correction_or_zero() - effect;
            break;
        case adjustment::Correction::scale:
            scale_correction = scale_correction.value_or(MilliGal(0.0)) - effect;
            break;
        case adjustment::Correction::pressure:
            if (!row.pressure_correction) break;
            row.acceleration = row.acceleration - effect;
            *row.pressure_correction = *row.pressure_correction - effect;
            break;
    }
}

bool has_two_faces(const std::vector<CorrectedRow>& rows) {
    return std::ranges::any_of(
        rows, [&rows](const CorrectedRow& one) { return one.row.face != rows.front().row.face; });
}

}  // namespace a351::corrector::model
