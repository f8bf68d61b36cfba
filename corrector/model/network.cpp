#include "corrector/model/network.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/model/adjusted_fit.hpp"
#include "corrector/model/model.hpp"
#include "corrector/model/network_words.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

using adjustment::AdjustedSurvey;
using adjustment::SurveyEquations;

bool temperature_varies(const std::vector<reading::SurveyRow>& rows,
                        const std::vector<bool>& in_use) {
    std::optional<DegC> first;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i]) continue;
        if (!first) first = rows[i].temperature;
        if (rows[i].temperature != *first) return true;
    }
    return false;
}

adjustment::Design design_of(const std::vector<reading::SurveyRow>& rows,
                             const std::vector<bool>& in_use, const SurveyOptions& options,
                             std::vector<text::Message>& remarks) {
    const adjustment::Priors& priors = options.priors;
    adjustment::Design design{std::string(kNetwork), {&adjustment::kConstant}, true, false};
    const std::array kDrift{&adjustment::kTime, &adjustment::kTime2, &adjustment::kTime3};
    for (int degree = 1; degree <= options.network.drift_degree; ++degree)
        design.terms.push_back(kDrift.at(static_cast<std::size_t>(degree) - 1));
    if (temperature_varies(rows, in_use) || priors.find(adjustment::kTemperature.name) != nullptr)
        design.terms.push_back(&adjustment::kTemperature);
    else
        remarks.push_back(
            rows.front().has_temperature
                ? text::message(
                      "the temperature does not vary between the readings: its coefficient cannot "
                      "be separated from the constant and is left out")
                : text::message("no temperature is given: the readings are taken as corrected for "
                                "it"));
    if (priors.find(adjustment::kRate.name) != nullptr) design.terms.push_back(&adjustment::kRate);
    if (options.network.fits_admittance) design.terms.push_back(&adjustment::kAdmittance);
    design.terms.push_back(&adjustment::kScaleTerm);
    return design;
}

NetworkPart part_of(const AdjustedSurvey& adjusted) {
    const adjustment::Adjustment& solution = adjusted.adjustment;
    NetworkPart part;
    const std::vector<std::string> labels = adjusted.survey.labels();
    for (std::size_t i = 0; i < labels.size(); ++i)
        part.rows.push_back({labels[i], -solution.residual(i), solution.equations().rows[i].sd,
                             solution.redundancy(i)});
    part.reading_count = adjusted.survey.readings().size();
    for (const adjustment::EquationStation& station : adjusted.survey.stations())
        if (station.held) part.held_sites.push_back(station.site);
    part.station_count = adjusted.survey.stations().size();
    part.unknown_count = part.station_count + adjusted.survey.terms().size();
    part.dof = solution.dof();
    part.weighted_square = solution.weighted_square();
    if (part.dof > 0) {
        const auto dof = static_cast<double>(part.dof);
        part.chi_square_low = signal::chi_square_quantile(dof, kGlobalTestAlpha);
        part.chi_square_high = signal::chi_square_upper_quantile(dof, kGlobalTestAlpha);
    }
    return part;
}

/// Returns the adjustment or a refusal; no part.
NetworkResult solved(const std::vector<reading::SurveyRow>& rows, const std::vector<bool>& in_use,
                     const SurveyOptions& options, adjustment::Cofactor cofactor) {
    NetworkResult result;
    SurveyEquations survey(
        rows, in_use, design_of(rows, in_use, options, result.remarks),
        {options.datum, options.priors, options.steps, MilliGal(options.network.datum_sd_mgal)});
    if (auto refusal = refusal_of(survey)) {
        result.refusal = std::move(*refusal);
        return result;
    }
    AdjustedSurvey adjusted = adjustment::adjust(std::move(survey), cofactor);
    if (!adjusted.is_determined())
        result.refusal = undetermined(adjusted);
    else if (adjusted.moved_mgal > adjustment::kSettled_mgal)
        result.refusal = {
            fmt::format(
                "scale and gravities do not settle: round {} moves a gravity by {:.4g} mGal",
                adjustment::kScaleRounds, adjusted.moved_mgal),
            "a narrower prior on scale, with which the mistake in a reading or a reference is "
            "searched"};
    else
        result.adjusted = std::move(adjusted);
    return result;
}

Score score_of(const NetworkResult& network, double reading_sd_mgal) {
    Score score;
    score.model = kNetwork;
    if (!network.adjusted) return score;
    const NetworkPart& part = network.part;
    score.row_count = part.reading_count;
    score.parameter_count = part.unknown_count;
    score.dof = part.dof;
    double squares = 0.0;
    for (std::size_t i = 0; i < part.reading_count; ++i)
        squares += part.rows[i].residual * part.rows[i].residual;
    score.rms_mgal = std::sqrt(squares / static_cast<double>(part.reading_count));
    if (const auto s0 = part.s0()) score.s_mgal = *s0 * reading_sd_mgal;
    const std::size_t datums = part.held_sites.size();
    if (datums < 2) return score;
    // Residual / redundancy is the error of predicting a datum without its own row.
    squares = 0.0;
    for (std::size_t k = 0; k < datums; ++k) {
        const NetworkRow& datum = part.rows[part.reading_count + k];
        if (datum.redundancy < adjustment::kLeastRedundancy) return score;
        squares += std::pow(datum.residual / datum.redundancy, 2);
    }
    score.loso_mgal = std::sqrt(squares / static_cast<double>(datums));
    return score;
}

/// Moves rows whose loop has no constant to left_out, with a remark.
void leave_out_untied(Fit& result, const AdjustedSurvey& adjusted) {
    std::vector<CorrectedRow> rows;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        if (adjusted.survey.loops()[i]) {
            rows.push_back(std::move(result.rows[i]));
            continue;
        }
        names.push_back(reading::stay_name(row.site, row.occupation));
        result.left_out.push_back({row.site, row.occupation, row.first_instant(),
                                   row.last_instant(), "no reading of its loop in use"});
    }
    result.rows = std::move(rows);
    if (names.empty()) return;
    result.remarks.push_back(
        text::message("no reading in use between two pauses of more than {} h, so the instrument's "
                      "constant is undetermined there: left out are {}",
                      std::lround(adjustment::kLoopPause_h), text::joined(names)));
}

FitResult fit_network(const SurveyProblem& problem, const RowChoice& choice) {
    NetworkResult network = adjust_network(problem.rows, choice.accepted, problem.options);
    if (!network.adjusted) return std::move(network.refusal);
    Fit result = fit_of(*network.adjusted, problem, choice);
    result.score = score_of(network, problem.options.priors.reading_sd_mgal);
    if (problem.options.network.fits_admittance)
        result.remarks.push_back(admittance_remark(result));
    if (!network.part.scatters_more_than_stated())
        for (StationValue& station : result.stations) {
            station.coverage_factor = kCoverageFactor;
            station.dof = static_cast<double>(network.part.dof);
        }
    set_hidden_references(result, *network.adjusted);
    leave_out_untied(result, *network.adjusted);
    result.remarks.insert(result.remarks.end(), network.remarks.begin(), network.remarks.end());
    result.own = std::move(network.part);
    return result;
}

Score score_network(const SurveyProblem& problem, const RowChoice& choice) {
    return score_of(adjust_network(problem.rows, choice.accepted, problem.options),
                    problem.options.priors.reading_sd_mgal);
}

/// Returns the adjustment without its Q.
std::optional<AdjustedSurvey> adjusted_network(const SurveyProblem& problem,
                                               const RowChoice& choice) {
    return solved(problem.rows, choice.accepted, problem.options, adjustment::Cofactor::left_out)
        .adjusted;
}

std::unique_ptr<adjustment::Trials> network_trials(const SurveyProblem& problem,
                                                   const RowChoice& choice) {
    std::optional<AdjustedSurvey> adjusted = adjusted_network(problem, choice);
    return adjusted ? adjustment::white_trials(std::move(*adjusted)) : nullptr;
}

}  // namespace

NetworkResult adjust_network(const std::vector<reading::SurveyRow>& rows,
                             const std::vector<bool>& in_use, const SurveyOptions& options) {
    NetworkResult result = solved(rows, in_use, options, adjustment::Cofactor::computed);
    if (!result.adjusted) return result;
    result.part = part_of(*result.adjusted);
    add_remarks(result);
    return result;
}

Model network_model() {
    return {kNetwork, false, true, fit_network, score_network, network_trials, adjusted_network};
}

}  // namespace a351::corrector::model
