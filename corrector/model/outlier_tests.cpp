#include "corrector/model/outlier_tests.hpp"

#include <fmt/core.h>

#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
std::string temperature_doubt(const reading::SurveyRow& row) {
    std::vector<std::string> reasons;
    if (std::abs(row.rate_degc_per_h) > kGreatestRate_degc_per_h)
        reasons.push_back(fmt::format("rate {} degC/h", text::fixed(row.rate_degc_per_h, 3)));
    if (row.record && row.record->temperature_range.value() > kGreatestRange_degc) {
        const std::string range = text::fixed(row.record->temperature_range.value(), 3);
        if (row.record->temperature_shape == reading::TemperatureShape::monotone)
            reasons.push_back(fmt::format("monotone over {} degC", range));
        else if (row.record->temperature_shape == reading::TemperatureShape::half_wave)
            reasons.push_back(fmt::format("half a wave of {} degC", range));
    }
    return text::joined(reasons, ";");
}

std::string physical_doubt(const reading::SurveyRow& row) {
    std::string reasons = temperature_doubt(row);
    for (const std::string& note : row.notes)
        if (note == "fallback" || note == "pulse") reasons += (reasons.empty() ? "" : ";") + note;
    return reasons;
}

std::optional<double> studentised_residual(double residual, double leverage, bool is_in_fit,
                                           const LinearFit& fit) {
    const Eigen::Index dof = fit.dof() - 1;
    const double rss = fit.rss + fit.prior_rss;
    if (dof <= 0) return std::nullopt;
    // s^2 (1 + h) for a row outside; s_i^2 (1 - h) for a row of the fit
    double variance = rss / static_cast<double>(dof + 1) * (1.0 + leverage);
    if (is_in_fit) {
        if (leverage > 1.0 - 1e-9) return std::nullopt;
        const double own = residual * residual / (1.0 - leverage);
        variance = (rss - own) / static_cast<double>(dof) * (1.0 - leverage);
    }
    if (!(variance > 0.0)) return std::nullopt;
    return residual / std::sqrt(variance);
}

}  // namespace a351::corrector::model
