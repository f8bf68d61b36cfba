#include "corrector/model/paper_correction.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "corrector/model/linear_fit.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<double> differences_mgal(const std::vector<SurveyRow>& rows) {
    std::vector<double> differences;
    for (const SurveyRow& row : rows)
        differences.push_back(row.reference ? (row.acceleration - *row.reference - row.tide).value()
                                            : kUnknown);
    return differences;
}

std::optional<TemperatureLine> fit_temperature_line(const std::vector<SurveyRow>& rows,
                                                    const std::vector<bool>& in_use) {
    const std::vector<double> differences = differences_mgal(rows);
    std::vector<double> x, y;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i] || !rows[i].reference) continue;
        x.push_back(rows[i].temperature.value());
        y.push_back(differences[i]);
    }
    const auto n = static_cast<Eigen::Index>(x.size());
    const auto fit = fit_linear(Eigen::Map<const Eigen::VectorXd>(x.data(), n),
                                Eigen::Map<const Eigen::VectorXd>(y.data(), n));
    if (!fit) return std::nullopt;
    return TemperatureLine{fit->coefficients(1), MilliGal(fit->coefficients(0)), fit->r_squared};
}

std::vector<double> temperature_corrected_mgal(const std::vector<SurveyRow>& rows,
                                               const TemperatureLine& line) {
    std::vector<double> corrected;
    for (const SurveyRow& row : rows) {
        const double temperature_effect =
            line.slope_mgal_per_degc * row.temperature.value() + line.intercept.value();
        corrected.push_back((row.acceleration - row.tide).value() - temperature_effect);
    }
    return corrected;
}

std::vector<double> errors_mgal(const std::vector<SurveyRow>& rows,
                                const std::vector<double>& corrected_mgal) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < rows.size(); ++i)
        errors.push_back(rows[i].reference ? rows[i].reference->value() - corrected_mgal[i]
                                           : kUnknown);
    return errors;
}

double EndPointDrift::rate_mgal_per_h() const {
    return total().value() / (seconds_between(first, last) / kSecondsPerHour);
}

MilliGal EndPointDrift::at(UtcTime time) const {
    return first_error + (seconds_between(first, time) / seconds_between(first, last)) * total();
}

DriftStep find_end_point_drift(const std::vector<SurveyRow>& rows, const std::vector<bool>& in_use,
                               const std::vector<double>& corrected1_mgal, std::string_view base) {
    const auto refuse = [base](const char* why) {
        return DriftStep{std::nullopt, fmt::format("base {} {}", base, why)};
    };
    std::vector<std::size_t> stays;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].site == base) stays.push_back(i);
    // Several set-ups of one stay are rows of one occupation, and give no drift.
    if (stays.empty() || rows[stays.front()].occupation == rows[stays.back()].occupation)
        return refuse("has fewer than two occupations, two are needed");
    const std::size_t first = stays.front(), last = stays.back();
    if (!rows[first].reference) return refuse("has no reference gravity");
    if (!in_use[first] && !in_use[last])
        return refuse("is not in use in its first and last occupation");
    const auto error = [&](std::size_t i) {
        return *rows[i].reference - MilliGal(corrected1_mgal[i]);
    };
    return {EndPointDrift{rows[first].time, rows[last].time, error(first), error(last)}, ""};
}

std::vector<double> drift_corrected_mgal(const std::vector<SurveyRow>& rows,
                                         const std::vector<double>& corrected1_mgal,
                                         const EndPointDrift& drift) {
    std::vector<double> corrected;
    for (std::size_t i = 0; i < rows.size(); ++i)
        corrected.push_back(corrected1_mgal[i] + drift.at(rows[i].time).value());
    return corrected;
}

MilliGal rms(const std::vector<double>& errors_mgal, const std::vector<bool>& in_use) {
    double sum = 0.0;
    int n = 0;
    for (std::size_t i = 0; i < errors_mgal.size(); ++i) {
        if (!in_use[i] || std::isnan(errors_mgal[i])) continue;
        sum += errors_mgal[i] * errors_mgal[i];
        ++n;
    }
    return MilliGal(n == 0 ? kUnknown : std::sqrt(sum / n));
}

}  // namespace a351::corrector
