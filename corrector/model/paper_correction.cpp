#include "corrector/model/paper_correction.hpp"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "corrector/model/model.hpp"
#include "protocol/core/units.hpp"
#include "protocol/linear_algebra/pivoted_qr.hpp"
#include "protocol/signal/distributions.hpp"

namespace a351::corrector::model {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Returns Error (2) of row `left_out`; line and drift are computed without this row.
std::optional<double> left_out_paper_error_mgal(std::vector<reading::SurveyRow> rows,
                                                std::vector<bool> in_use, std::size_t left_out,
                                                std::string_view base) {
    const reading::SurveyRow row = rows[left_out];
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(left_out));
    in_use.erase(in_use.begin() + static_cast<std::ptrdiff_t>(left_out));
    const auto line = fit_temperature_line(rows, in_use);
    if (!line) return std::nullopt;
    const DriftStep step =
        find_end_point_drift(rows, in_use, temperature_corrected_mgal(rows, *line), base);
    if (!step.drift) return std::nullopt;
    const std::vector<double> corrected1 = temperature_corrected_mgal({row}, *line);
    return errors_mgal({row}, drift_corrected_mgal({row}, corrected1, *step.drift)).front();
}

Score score_paper(const SurveyProblem& problem, const RowChoice& choice) {
    return score_paper_model(problem.rows, choice.in_use, problem.options.base);
}

/// Sets the stations: means of their accepted rows, or of all their rows if none is accepted.
void set_stations(Fit& result, const RowChoice& choice, const Line& line) {
    for (const CorrectedRow& first : result.rows) {
        const std::string& site = first.row.site;
        if (result.station(site) != nullptr) continue;
        StationValue station;
        station.site = site;
        station.reference = first.row.reference;
        station.is_flagged_only = true;
        for (std::size_t i = 0; i < result.rows.size(); ++i)
            if (result.rows[i].row.site == site && choice.accepted[i])
                station.is_flagged_only = false;
        double sum = 0.0, degc = 0.0;
        for (std::size_t i = 0; i < result.rows.size(); ++i) {
            const CorrectedRow& row = result.rows[i];
            if (row.row.site != site) continue;
            if (row.is_used)
                station.redundancy = station.redundancy.value_or(0.0) + 1.0 - row.leverage.value();
            if (!station.is_flagged_only && !choice.accepted[i]) continue;
            ++station.row_count;
            sum += row.corrected.value();
            degc += row.row.temperature.value();
        }
        const auto n = static_cast<double>(station.row_count);
        station.gravity = MilliGal(sum / n);
        if (const auto s_mgal = result.score.s_mgal) {
            // u^2 = s^2 / n + var(line(mean T of its rows))
            station.u_gravity = MilliGal(
                std::sqrt(*s_mgal * *s_mgal / n + *s_mgal * *s_mgal * line.leverage_at(degc / n)));
            if (line.count > 2) {
                station.dof = static_cast<double>(line.count - 2);
                station.coverage_factor = signal::students_t_quantile(*station.dof, 0.975);
            }
        }
        if (station.reference) station.residual = station.gravity - *station.reference;
        result.stations.push_back(std::move(station));
    }
}

FitResult fit_paper(const SurveyProblem& problem, const RowChoice& choice) {
    const std::vector<reading::SurveyRow>& rows = problem.rows;
    const std::optional<Line> line = fit_temperature_line(rows, choice.in_use);
    if (!line)
        return Refusal{fmt::format("{} rows with a reference do not determine it",
                                   std::ranges::count(choice.in_use, true)),
                       "at least 2 rows between which the temperature varies"};
    const std::vector<double> corrected1 = temperature_corrected_mgal(rows, *line);
    const DriftStep step =
        find_end_point_drift(rows, choice.in_use, corrected1, problem.options.base);
    if (!step.drift)
        return Refusal{"the drift step is refused, " + step.refusal,
                       "another base, or a model of auto, t, t-rate, t-drift, t-rate-drift"};
    const std::vector<double> corrected2 = drift_corrected_mgal(rows, corrected1, *step.drift);
    Fit result;
    result.rows = uncorrected(problem, choice);
    result.score = score_paper(problem, choice);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CorrectedRow& out = result.rows[i];
        const MilliGal first(corrected1[i]);
        PaperRow& own = out.own.emplace<PaperRow>(PaperRow{first, std::nullopt});
        if (rows[i].reference) own.residual1 = first - *rows[i].reference;
        out.corrected = MilliGal(corrected2[i]);
        out.temperature_correction = first - rows[i].reduced();
        out.drift_correction = step.drift->at(rows[i].time);
        if (rows[i].reference) out.residual = out.corrected - *rows[i].reference;
        out.leverage = line->leverage_at(rows[i].temperature.value());
        // u^2 = s^2 + var(line(T))
        if (const auto s = result.score.s_mgal)
            out.u_corrected = MilliGal(std::sqrt(*s * *s + *s * *s * *out.leverage));
    }
    std::optional<double> slope_error;
    if (line->count > 2)
        slope_error = std::sqrt(line->rss / static_cast<double>(line->count - 2)) *
                      std::sqrt(line->slope_cofactor);
    result.coefficients = {
        {"temperature_mgal_per_degc", line->slope, slope_error},
        {"intercept_at_0_degc_mgal", line->intercept, std::nullopt},
        {"r_squared", line->r_squared, std::nullopt},
        {"first_base_error_mgal", step.drift->first_error.value(), std::nullopt},
        {"last_base_error_mgal", step.drift->last_error.value(), std::nullopt},
        {"drift_mgal_per_h", step.drift->rate_mgal_per_h(), std::nullopt},
    };
    set_stations(result, choice, *line);
    return result;
}

}  // namespace

std::optional<Line> line_through(const std::vector<double>& x, const std::vector<double>& y) {
    const auto n = static_cast<Eigen::Index>(x.size());
    if (n < 2) return std::nullopt;
    const Eigen::Map<const Eigen::VectorXd> of_x(x.data(), n), of_y(y.data(), n);
    const double mean_x = of_x.mean(), mean_y = of_y.mean();
    // Centred, so that full values near 980000 mGal keep their last digits.
    const Eigen::MatrixXd centred_x = of_x.array() - mean_x;
    const Eigen::VectorXd centred_y = of_y.array() - mean_y;
    const linear_algebra::PivotedQr qr(centred_x);
    // Centring is exact to about 1e-16 of the values; the rest of a constant column is noise.
    const double noise = 1e-12 * (1.0 + of_x.cwiseAbs().maxCoeff()) * std::sqrt(x.size());
    if (!(qr.pivots()(0) > noise)) return std::nullopt;
    Line line;
    line.slope = qr.solve(centred_y)(0);
    line.intercept = mean_y - line.slope * mean_x;
    line.mean_x = mean_x;
    line.mean_y = mean_y;
    line.count = x.size();
    line.slope_cofactor = qr.cofactor_root().squaredNorm();
    line.rss = (centred_y - centred_x * line.slope).squaredNorm();
    const double total = centred_y.squaredNorm();
    line.r_squared = total > 0.0 ? 1.0 - line.rss / total : kUnknown;
    return line;
}

std::vector<double> differences_mgal(const std::vector<reading::SurveyRow>& rows) {
    std::vector<double> differences;
    for (const reading::SurveyRow& row : rows)
        differences.push_back(row.reference ? (row.acceleration - *row.reference - row.tide).value()
                                            : kUnknown);
    return differences;
}

std::optional<Line> fit_temperature_line(const std::vector<reading::SurveyRow>& rows,
                                         const std::vector<bool>& in_use) {
    const std::vector<double> differences = differences_mgal(rows);
    std::vector<double> x, y;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i] || !rows[i].reference) continue;
        x.push_back(rows[i].temperature.value());
        y.push_back(differences[i]);
    }
    return line_through(x, y);
}

std::vector<double> temperature_corrected_mgal(const std::vector<reading::SurveyRow>& rows,
                                               const Line& line) {
    std::vector<double> corrected;
    for (const reading::SurveyRow& row : rows) {
        // Equation (3), with the reading where the publication prints the reference.
        const double temperature_effect = line.slope * row.temperature.value() + line.intercept;
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

Score score_paper_model(const std::vector<reading::SurveyRow>& rows,
                        const std::vector<bool>& in_use, std::string_view base) {
    Score score;
    score.model = "paper";
    score.row_count = static_cast<std::size_t>(std::ranges::count(in_use, true));
    score.parameter_count = 4;  // slope, intercept, and the errors at both ends of the drift
    const auto line = fit_temperature_line(rows, in_use);
    if (!line) return score;
    const std::vector<double> corrected1 = temperature_corrected_mgal(rows, *line);
    score.rms_before_drift_mgal = rms(errors_mgal(rows, corrected1), in_use).value();
    const DriftStep step = find_end_point_drift(rows, in_use, corrected1, base);
    if (!step.drift) return score;
    const auto n = static_cast<double>(score.row_count);
    score.dof = score.row_count - std::min(score.row_count, score.parameter_count);
    const std::vector<double> corrected2 = drift_corrected_mgal(rows, corrected1, *step.drift);
    score.rms_mgal = rms(errors_mgal(rows, corrected2), in_use).value();
    if (score.dof > 0)
        score.s_mgal = *score.rms_mgal * std::sqrt(n / static_cast<double>(score.dof));

    double sum = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i]) continue;
        const auto error = left_out_paper_error_mgal(rows, in_use, i, base);
        if (!error) return score;
        sum += *error * *error;
    }
    score.loo_mgal = std::sqrt(sum / n);
    return score;
}

Model paper_model() { return {kPaper, true, false, fit_paper, score_paper}; }

}  // namespace a351::corrector::model
