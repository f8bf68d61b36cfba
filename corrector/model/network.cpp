#include "corrector/model/network.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "corrector/model/adjusted_fit.hpp"
#include "corrector/model/model.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

using adjustment::AdjustedSurvey;
using adjustment::SurveyEquations;

std::string named(const SurveyEquations& survey, const std::set<std::size_t>& stations) {
    std::vector<std::string> names;
    for (const std::size_t station : stations) names.push_back(survey.stations()[station].site);
    return text::joined(names);
}

bool holds_datum(const SurveyEquations& survey, const std::set<std::size_t>& stations) {
    return std::ranges::any_of(
        stations, [&](std::size_t station) { return survey.stations()[station].held.has_value(); });
}

/// Returns the groups of stations that no chain of stations and loops connects with a datum, as one
/// text of joined names per group; empty if there are none.
std::vector<std::string> unconnected_groups(const SurveyEquations& survey) {
    // The stations of a loop are connected, because they share its constant: merge their groups.
    std::vector<std::size_t> group(survey.stations().size());
    std::iota(group.begin(), group.end(), std::size_t(0));
    std::map<std::size_t, std::size_t> first_of_loop;
    for (const adjustment::ReadingRow& reading : survey.readings()) {
        const std::size_t station = *reading.station;
        const auto [first, is_new] = first_of_loop.emplace(*survey.loops()[reading.row], station);
        if (is_new) continue;
        const std::size_t from = group[station], to = group[first->second];
        std::ranges::replace(group, from, to);
    }
    std::map<std::size_t, std::set<std::size_t>> members;
    for (std::size_t station = 0; station < group.size(); ++station)
        members[group[station]].insert(station);
    std::vector<std::string> groups;
    for (const auto& [id, stations] : members)
        if (!holds_datum(survey, stations)) groups.push_back(named(survey, stations));
    return groups;
}

/// Returns the groups of stations that only the instrument's constant and drift connect with a
/// datum, because no station is occupied both before and after.
std::vector<std::string> groups_tied_by_drift(const SurveyEquations& survey) {
    std::map<std::size_t, std::size_t> last_reading;
    for (std::size_t i = 0; i < survey.readings().size(); ++i)
        last_reading[*survey.readings()[i].station] = i;
    std::vector<std::string> groups;
    std::set<std::size_t> group;
    std::size_t last = 0;
    for (std::size_t i = 0; i < survey.readings().size(); ++i) {
        const std::size_t station = *survey.readings()[i].station;
        group.insert(station);
        last = std::max(last, last_reading[station]);
        // A group ends if none of its stations is occupied again later.
        if (last > i) continue;
        if (!holds_datum(survey, group)) groups.push_back(named(survey, group));
        group.clear();
    }
    return groups;
}

/// Returns true if a station was read twice in one loop.
bool has_repeat(const SurveyEquations& survey) {
    std::set<std::pair<std::size_t, std::size_t>> seen;
    return std::ranges::any_of(survey.readings(), [&](const adjustment::ReadingRow& reading) {
        return !seen.emplace(*survey.loops()[reading.row], *reading.station).second;
    });
}

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
                             const std::vector<bool>& in_use, const adjustment::Priors& priors,
                             const NetworkOptions& options, std::vector<text::Message>& remarks) {
    adjustment::Design design{std::string(kNetwork), {&adjustment::kConstant}, true, false};
    const std::array kDrift{&adjustment::kTime, &adjustment::kTime2, &adjustment::kTime3};
    for (int degree = 1; degree <= options.drift_degree; ++degree)
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
    if (options.fits_admittance) design.terms.push_back(&adjustment::kAdmittance);
    design.terms.push_back(&adjustment::kScaleTerm);
    return design;
}

/// Says where the loops of gravimeters begin; nothing with one loop.
text::Message loops_remark(const SurveyEquations& survey) {
    std::vector<bool> is_named(survey.loop_count(), false);
    text::Message remark;
    std::size_t count = 0;
    for (std::size_t i = 0; i < survey.rows().size(); ++i) {
        const reading::SurveyRow& row = survey.rows()[i];
        if (!survey.loops()[i] || row.instrument.empty() || is_named[*survey.loops()[i]]) continue;
        const std::size_t loop = *survey.loops()[i];
        is_named[loop] = true;
        const std::string from = to_rfc3339(survey.origin_of(loop));
        remark += count++ == 0
                      ? text::message("loop {} is {} from {}", loop + 1, row.instrument, from)
                      : text::message("; loop {} is {} from {}", loop + 1, row.instrument, from);
    }
    return count > 1 ? remark : text::Message();
}

/// Returns why these unknowns are undetermined, and what would help.
Refusal undetermined(const AdjustedSurvey& adjusted) {
    const SurveyEquations& survey = adjusted.survey;
    std::vector<std::string> names;
    bool has_drift = false;
    for (const std::size_t k : adjusted.adjustment.undetermined()) {
        if (k < survey.stations().size()) {
            names.push_back(survey.stations()[k].site);
            continue;
        }
        const adjustment::SurveyTerm& term = survey.terms()[k - survey.stations().size()];
        names.push_back(term.name);
        has_drift = has_drift || term.name.starts_with("time");
    }
    return {fmt::format("the readings do not determine {}: {}", text::joined(names),
                        has_repeat(survey)
                            ? "there are fewer repeated readings than coefficients to determine"
                            : fmt::format("every station is occupied only once in its loop, "
                                          "and a pause of more than {} h begins a loop",
                                          std::lround(adjustment::kLoopPause_h))),
            has_drift ? "further occupations of a station at other times, more datum stations, a "
                        "prior on time_mgal_per_h, or a smaller drift_degree"
                      : "further occupations, more datum stations, or a prior on a coefficient"};
}

/// Returns why the equations cannot be solved, without looking at the times.
std::optional<Refusal> refusal_of(const SurveyEquations& survey) {
    for (const adjustment::EquationStation& station : survey.stations())
        if (!station.held && std::ranges::find(survey.knowledge().datum, station.site) !=
                                 survey.knowledge().datum.end())
            return Refusal{fmt::format("datum = {}: no reference gravity", station.site),
                           "stations with gravity_mgal"};
    std::set<std::size_t> all;
    for (std::size_t k = 0; k < survey.stations().size(); ++k) all.insert(k);
    if (all.empty()) return Refusal{"no reading in use", "at least one"};
    if (!holds_datum(survey, all))
        return Refusal{
            "no datum: none of the stations in use has a reference that is held, so the "
            "constant is undetermined",
            fmt::format("gravity_mgal of at least one occupied station ({})", named(survey, all))};
    if (const auto groups = unconnected_groups(survey); !groups.empty())
        return Refusal{
            fmt::format("unconnected: no chain of stations and loops joins a datum to {}",
                        text::joined(groups, "; ")),
            "a datum in every group, or its rows taken out of use"};
    return std::nullopt;
}

void add_remarks(NetworkResult& result) {
    const SurveyEquations& survey = result.adjusted->survey;
    if (text::Message loops = loops_remark(survey); !loops.empty())
        result.remarks.push_back(std::move(loops));
    const std::vector<std::string> tied = groups_tied_by_drift(survey);
    if (!tied.empty())
        result.remarks.push_back(text::message(
            "connected with a datum only by the instrument's constant and drift, because no "
            "station is occupied before and after: {}",
            text::joined(tied, "; ")));
    // Datum rows are not checked: their redundancy is always small, because a wrong reference shows
    // in the residuals of the readings.
    std::vector<std::string> uncontrolled;
    for (std::size_t i = 0; i < result.part.reading_count; ++i)
        if (result.part.rows[i].redundancy < kControlledRedundancy)
            uncontrolled.push_back(result.part.rows[i].label);
    if (!uncontrolled.empty())
        result.remarks.push_back(text::message(
            "practically uncontrolled (redundancy below 0.1), a blunder there cannot be found: {}",
            text::joined(uncontrolled)));
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
                     adjustment::SurveyKnowledge knowledge, const NetworkOptions& options,
                     adjustment::Cofactor cofactor) {
    NetworkResult result;
    adjustment::Design design = design_of(rows, in_use, knowledge.priors, options, result.remarks);
    SurveyEquations survey(rows, in_use, std::move(design), std::move(knowledge));
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

NetworkResult adjust(const SurveyProblem& problem, const RowChoice& choice) {
    const SurveyOptions& options = problem.options;
    return adjust_network(problem.rows, choice.accepted, options.datum, options.priors,
                          options.network, options.steps);
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

/// Correlation of the pressure with the readings, over the rows in use.
double pressure_correlation(const std::vector<CorrectedRow>& rows) {
    double n = 0.0, p = 0.0, g = 0.0, pp = 0.0, gg = 0.0, pg = 0.0;
    for (const CorrectedRow& of : rows) {
        const reading::SurveyRow& row = of.row;
        if (!of.is_used || !row.pressure_hpa) continue;
        // From the first row, to keep the digits.
        const double x = *row.pressure_hpa - rows.front().row.pressure_hpa.value_or(0.0);
        const double y = (row.measured() - row.tide - rows.front().row.measured()).value();
        n += 1.0;
        p += x;
        g += y;
        pp += x * x;
        gg += y * y;
        pg += x * y;
    }
    return (pg - p * g / n) / std::sqrt((pp - p * p / n) * (gg - g * g / n));
}

/// Returns the fitted admittance in words.  The sentence also says whether the readings can
/// distinguish it from gravity.
text::Message admittance_remark(const Fit& result) {
    // Real admittances are -0.0002 to -0.0004 mGal/hPa: a value whose error is larger than half
    // this range is not better than the usual one.
    constexpr double kUsual_mgal_per_hpa = -0.0003, kGoodError_mgal_per_hpa = 0.0001;
    const Coefficient& admittance =
        *std::ranges::find(result.coefficients, adjustment::kAdmittance.name, &Coefficient::name);
    const double u = admittance.standard_error.value();
    return text::message(
        "admittance {:.5f} +- {:.5f} mGal/hPa, fitted; pressure and readings correlate by {:.3f}{}",
        admittance.value, u, pressure_correlation(result.rows),
        u <= kGoodError_mgal_per_hpa
            ? text::Message()
            : text::message(": it cannot be distinguished from gravity and drift, use the fixed {}",
                            kUsual_mgal_per_hpa));
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
        names.push_back(fmt::format("{} ({})", row.site, row.occupation));
        result.left_out.push_back({row.site, row.occupation, row.start.value_or(row.time),
                                   row.end.value_or(row.time), "no reading of its loop in use"});
    }
    result.rows = std::move(rows);
    if (names.empty()) return;
    result.remarks.push_back(
        text::message("no reading in use between two pauses of more than {} h, so the instrument's "
                      "constant is undetermined there: left out are {}",
                      std::lround(adjustment::kLoopPause_h), text::joined(names)));
}

FitResult fit_network(const SurveyProblem& problem, const RowChoice& choice) {
    NetworkResult network = adjust(problem, choice);
    if (!network.adjusted) return std::move(network.refusal);
    Fit result = fit_of(*network.adjusted, problem, choice);
    result.score = score_of(network, problem.options.priors.reading_sd_mgal);
    if (problem.options.network.fits_admittance)
        result.remarks.push_back(admittance_remark(result));
    if (network.part.passes_global_test().value_or(true))
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
    return score_of(adjust(problem, choice), problem.options.priors.reading_sd_mgal);
}

/// Returns the adjustment without its Q.
std::optional<AdjustedSurvey> adjusted_network(const SurveyProblem& problem,
                                               const RowChoice& choice) {
    const SurveyOptions& options = problem.options;
    return solved(problem.rows, choice.accepted,
                  {options.datum, options.priors, options.steps,
                   MilliGal(options.network.datum_sd_mgal)},
                  options.network, adjustment::Cofactor::left_out)
        .adjusted;
}

std::unique_ptr<adjustment::Trials> network_trials(const SurveyProblem& problem,
                                                   const RowChoice& choice) {
    std::optional<AdjustedSurvey> adjusted = adjusted_network(problem, choice);
    return adjusted ? adjustment::white_trials(std::move(*adjusted)) : nullptr;
}

}  // namespace

NetworkResult adjust_network(const std::vector<reading::SurveyRow>& rows,
                             const std::vector<bool>& in_use, const std::vector<std::string>& datum,
                             const adjustment::Priors& priors, const NetworkOptions& options,
                             const std::vector<adjustment::Step>& steps) {
    NetworkResult result =
        solved(rows, in_use, {datum, priors, steps, MilliGal(options.datum_sd_mgal)}, options,
               adjustment::Cofactor::computed);
    if (!result.adjusted) return result;
    result.part = part_of(*result.adjusted);
    add_remarks(result);
    return result;
}

Model network_model() {
    return {kNetwork, false, true, fit_network, score_network, network_trials, adjusted_network};
}

}  // namespace a351::corrector::model
