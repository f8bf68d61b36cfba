#include "corrector/model/paper_correction.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "corrector/model/applied_fit.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::model {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Score score_paper(const SurveyProblem& problem, const RowChoice& choice) {
    return score_paper_model(problem.rows, choice.in_use, problem.options.base);
}

FitResult fit_paper(const SurveyProblem& problem, const RowChoice& choice) {
    const std::vector<reading::SurveyRow>& rows = problem.rows;
    // The publication's line has no priors.
    auto line_fit = apply_model(kLinearModels.front(), problem, choice, {});
    if (auto* const refusal = std::get_if<Refusal>(&line_fit)) return std::move(*refusal);
    const auto& applied = std::get<AppliedFit>(line_fit);
    const TemperatureLine line = fit_temperature_line(rows, choice.in_use).value();
    const std::vector<double> corrected1 = temperature_corrected_mgal(rows, line);
    const DriftStep step =
        find_end_point_drift(rows, choice.in_use, corrected1, problem.options.base);
    if (!step.drift)
        return Refusal{"the drift step is refused, " + step.refusal,
                       "another base, or a model of auto, t, t-rate, t-drift, t-rate-drift"};
    const std::vector<double> corrected2 = drift_corrected_mgal(rows, corrected1, *step.drift);
    Fit result;
    result.own = PaperPart{};
    result.rows = uncorrected(problem, choice);
    result.score = score_paper(problem, choice);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CorrectedRow& out = result.rows[i];
        const MilliGal first(corrected1[i]);
        PaperRow& own = out.own.emplace<PaperRow>(PaperRow{first, std::nullopt});
        if (rows[i].reference) own.residual1 = *rows[i].reference - first;
        out.corrected = MilliGal(corrected2[i]);
        out.temperature_correction = first - rows[i].reduced();
        out.drift_correction = step.drift->at(rows[i].time);
        if (rows[i].reference) out.residual = *rows[i].reference - out.corrected;
        set_uncertainty(out, applied, i, result.score.s_mgal);
    }
    std::optional<double> slope_error;
    if (applied.s_mgal) slope_error = *applied.s_mgal * std::sqrt(applied.fit.cofactor(1, 1));
    result.coefficients = {
        {"temperature_mgal_per_degc", line.slope_mgal_per_degc, slope_error},
        {"intercept_at_0_degc_mgal", line.intercept.value(), std::nullopt},
        {"r_squared", line.r_squared, std::nullopt},
        {"first_base_error_mgal", step.drift->first_error.value(), std::nullopt},
        {"last_base_error_mgal", step.drift->last_error.value(), std::nullopt},
        {"drift_mgal_per_h", step.drift->rate_mgal_per_h(), std::nullopt},
    };
    result.stations = average_stations(result, choice.accepted, applied, result.score.s_mgal);
    return result;
}

}  // namespace

std::vector<double> differences_mgal(const std::vector<reading::SurveyRow>& rows) {
    std::vector<double> differences;
    for (const reading::SurveyRow& row : rows)
        differences.push_back(row.reference ? (row.acceleration - *row.reference - row.tide).value()
                                            : kUnknown);
    return differences;
}

std::optional<TemperatureLine> fit_temperature_line(const std::vector<reading::SurveyRow>& rows,
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

std::vector<double> temperature_corrected_mgal(const std::vector<reading::SurveyRow>& rows,
                                               const TemperatureLine& line) {
    std::vector<double> corrected;
    for (const reading::SurveyRow& row : rows) {
        // Equation (3), with the reading where the publication prints the reference.
        const double temperature_effect =
            line.slope_mgal_per_degc * row.temperature.value() + line.intercept.value();
        corrected.push_back(row.reduced().value() - temperature_effect);
    }
    return corrected;
}

std::vector<double> errors_mgal(const std::vector<reading::SurveyRow>& rows,
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

DriftStep find_end_point_drift(const std::vector<reading::SurveyRow>& rows,
                               const std::vector<bool>& in_use,
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

std::vector<double> drift_corrected_mgal(const std::vector<reading::SurveyRow>& rows,
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

Model paper_model() { return {kPaper, true, fit_paper, score_paper}; }

}  // namespace a351::corrector::model
