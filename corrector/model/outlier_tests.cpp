#include "corrector/model/outlier_tests.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
std::string temperature_doubt(const SurveyRow& row) {
    std::string reasons;
    if (std::abs(row.rate_degc_per_h) > kGreatestRate_degc_per_h) {
        reasons = "rate " + text::fixed(row.rate_degc_per_h, 3) + " degC/h";
    }
    if (!row.record) return reasons;
    const double range_degc = row.record->temperature_range.value();
    if (!(range_degc > kGreatestRange_degc)) return reasons;
    const std::string join = reasons.empty() ? "" : ";";
    if (row.record->temperature_shape == TemperatureShape::monotone) {
        reasons += join + "monotone over " + text::fixed(range_degc, 3) + " degC";
    } else if (row.record->temperature_shape == TemperatureShape::half_wave) {
        reasons += join + "half a wave of " + text::fixed(range_degc, 3) + " degC";
    }
    return reasons;
}

std::string physical_doubt(const SurveyRow& row) {
    std::string reasons = temperature_doubt(row);
    for (const std::string& note : row.notes) {
        if (note == "fallback" || note == "pulse") reasons += (reasons.empty() ? "" : ";") + note;
    }
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

double studentised_limit(std::size_t n, double dof) {
    const boost::math::students_t distribution(dof);
    return boost::math::quantile(
        boost::math::complement(distribution, kOutlierAlpha / (2.0 * static_cast<double>(n))));
}

std::vector<std::optional<StatisticalDoubt>> find_outliers(std::vector<bool> in_use,
                                                           const Refit& refit) {
    const std::vector<bool> in_use_at_first = in_use;
    std::vector<std::optional<StatisticalDoubt>> doubts(in_use.size());
    for (;;) {
        const auto rows = refit(in_use);
        if (!rows || rows->dof < 2) return doubts;
        const auto n = static_cast<std::size_t>(std::count(in_use.begin(), in_use.end(), true));
        const double limit = studentised_limit(n, static_cast<double>(rows->dof - 1));
        const auto size_of = [&](std::size_t i) { return std::abs(rows->values[i].value_or(0.0)); };
        std::optional<std::size_t> worst;
        for (std::size_t i = 0; i < in_use.size(); ++i) {
            if (in_use[i] && (!worst || size_of(i) > size_of(*worst))) worst = i;
        }
        if (worst && size_of(*worst) > limit) {
            doubts[*worst] = {*rows->values[*worst], limit};
            in_use[*worst] = false;
            continue;
        }
        // A row outside the fit is tested with s of the whole fit, which has dof, not dof - 1.
        const double limit_outside = studentised_limit(n, static_cast<double>(rows->dof));
        for (std::size_t i = 0; i < in_use.size(); ++i) {
            if (in_use_at_first[i] || size_of(i) <= limit_outside) continue;
            doubts[i] = {*rows->values[i], limit_outside};
        }
        return doubts;
    }
}

}  // namespace a351::corrector
