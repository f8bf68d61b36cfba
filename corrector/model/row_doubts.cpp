#include "corrector/model/row_doubts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/model/outlier_tests.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

std::optional<StudentisedRows> refit_linear(const LinearModel& model,
                                            const std::vector<reading::SurveyRow>& rows,
                                            const TimeOrigin& origin, const Priors& priors,
                                            const std::vector<bool>& in_use) {
    const auto fit = fit_model(model, chosen_rows(rows, in_use), origin, priors);
    if (!fit) return std::nullopt;
    StudentisedRows result;
    result.dof = static_cast<std::size_t>(fit->dof());
    result.values.resize(rows.size());
    const Eigen::MatrixXd columns = model_columns(model, rows, origin);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!rows[i].reference) continue;
        const Eigen::VectorXd x = columns.row(static_cast<Eigen::Index>(i)).transpose();
        const MilliGal corrected = rows[i].acceleration - rows[i].tide - MilliGal(fit->at(x));
        result.values[i] = studentised_residual((*rows[i].reference - corrected).value(),
                                                fit->leverage_at(x), in_use[i], *fit);
    }
    return result;
}

std::string statistical_doubt(double studentised, double limit) {
    return fmt::format("t {} over {}", text::fixed(studentised, 2), text::fixed(limit, 2));
}

}  // namespace

void doubt_in_turn(std::vector<CorrectedRow>& rows, const Refit& refit) {
    std::vector<reading::SurveyRow> survey_rows;
    std::vector<bool> in_use_at_first;
    for (const CorrectedRow& row : rows) {
        survey_rows.push_back(row.row);
        in_use_at_first.push_back(row.is_used);
    }
    std::vector<bool> in_use = in_use_at_first;
    for (;;) {
        const std::optional<StudentisedRows> fit = refit(survey_rows, in_use);
        if (!fit || fit->dof < 2) return;
        const auto n = static_cast<std::size_t>(std::count(in_use.begin(), in_use.end(), true));
        const auto size_of = [&](std::size_t i) { return std::abs(fit->values[i].value_or(0.0)); };
        const auto doubt = [&](std::size_t i, double limit) {
            rows[i].doubt_statistical = statistical_doubt(*fit->values[i], limit);
        };
        std::optional<std::size_t> worst;
        for (std::size_t i = 0; i < in_use.size(); ++i)
            if (in_use[i] && (!worst || size_of(i) > size_of(*worst))) worst = i;
        const double limit = studentised_limit(n, static_cast<double>(fit->dof - 1));
        if (worst && size_of(*worst) > limit) {
            doubt(*worst, limit);
            in_use[*worst] = false;
            continue;
        }
        // A row outside the fit is tested with s of the whole fit, which has dof, not dof - 1.
        const double limit_outside = studentised_limit(n, static_cast<double>(fit->dof));
        for (std::size_t i = 0; i < in_use.size(); ++i)
            if (!in_use_at_first[i] && size_of(i) > limit_outside) doubt(i, limit_outside);
        return;
    }
}

void doubt_by_linear_fit(std::vector<CorrectedRow>& rows, const LinearModel& model,
                         const TimeOrigin& origin, const Priors& priors) {
    doubt_in_turn(rows,
                  [&](const std::vector<reading::SurveyRow>& all, const std::vector<bool>& in_use) {
                      return refit_linear(model, all, origin, priors, in_use);
                  });
}

void doubt_by_prediction(Fit& result) {
    for (CorrectedRow& row : result.rows) {
        const auto station = std::ranges::find(result.stations, row.row.site, &StationValue::site);
        if (!row.studentised_residual || !station->dof) continue;
        const double limit = studentised_limit(result.score.row_count, *station->dof);
        if (std::abs(*row.studentised_residual) > limit)
            row.doubt_statistical = statistical_doubt(*row.studentised_residual, limit);
    }
}

std::string doubts_text(const SurveyCorrection& result) {
    std::string text;
    for (const CorrectedRow& row : result.rows) {
        if (row.doubt_physical.empty() && row.doubt_statistical.empty()) continue;
        text += fmt::format("  {} ({}):", row.row.site, row.row.occupation);
        if (!row.doubt_physical.empty()) text += " physical: " + row.doubt_physical;
        if (!row.doubt_physical.empty() && !row.doubt_statistical.empty()) text += ',';
        if (!row.doubt_statistical.empty()) text += " statistical: " + row.doubt_statistical;
        text += '\n';
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
