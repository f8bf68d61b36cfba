#include "corrector/model/adjusted_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "protocol/signal/distributions.hpp"

namespace a351::corrector::model {
namespace {

using adjustment::AdjustedSurvey;
using adjustment::Combination;
using adjustment::Correction;
using adjustment::Entry;

/// Standard deviation of the readings: that of the priors times `ratio`.
struct Noise {
    double ratio = 1.0;
    bool is_known = true;  ///< False: nothing is left to estimate it.
};

Noise noise_of(const AdjustedSurvey& adjusted) {
    if (!adjusted.survey.design().is_exact) return {};
    const auto s0 = adjusted.adjustment.s0();
    return {s0.value_or(1.0), s0.has_value()};
}

/// Returns the sum of combinations times a factor.
Combination sum_of(const std::vector<Combination>& parts, double factor) {
    Combination sum;
    for (const Combination& part : parts)
        for (const Entry& entry : part) {
            const auto at = std::ranges::find(sum, entry.unknown, &Entry::unknown);
            if (at == sum.end())
                sum.push_back({entry.unknown, factor * entry.factor});
            else
                at->factor += factor * entry.factor;
        }
    return sum;
}

void correct_row(CorrectedRow& out, const AdjustedSurvey& adjusted, std::size_t row) {
    double effects_mgal = 0.0;
    for (const Entry& part : adjusted.survey.effects(row)) {
        const MilliGal effect(adjusted.effect_mgal(part));
        effects_mgal += effect.value();
        const Correction correction = adjusted.survey.terms()[part.unknown].correction;
        out.subtract(correction, effect);
        // The acceleration is already without it.
        if (correction == Correction::pressure && out.row.pressure_correction)
            effects_mgal -= effect.value();
    }
    out.corrected = out.row.reduced() - MilliGal(effects_mgal);
    if (out.row.reference) out.residual = out.corrected - *out.row.reference;
}

/// Sets what depends on the noise: leverage, u, studentised residual.
void judge_row(CorrectedRow& out, const AdjustedSurvey& adjusted, std::size_t row,
               const Noise& noise) {
    const adjustment::Adjustment& solution = adjusted.adjustment;
    const Combination effects = adjusted.survey.effects_as_unknowns(row);
    const double sd = adjusted.survey.sd_mgal(row);
    if (noise.is_known)
        out.u_corrected = MilliGal(std::sqrt(noise.ratio * noise.ratio * sd * sd +
                                             solution.variance(effects, noise.ratio)));
    if (const auto equation = adjusted.survey.equation_of(row)) {
        out.leverage = 1.0 - solution.redundancy(*equation);
        if (const auto t = solution.studentised(*equation)) out.studentised_residual = -*t;
        return;
    }
    out.leverage = solution.variance(effects) / (sd * sd);
    const auto s0 = solution.s0();
    if (adjusted.survey.design().is_exact && out.residual && s0 && solution.dof() > 1 && *s0 > 0.0)
        out.studentised_residual =
            out.residual->value() / (*s0 * sd * std::sqrt(1.0 + *out.leverage));
}

void set_coefficients(Fit& result, const AdjustedSurvey& adjusted, const Noise& noise) {
    for (std::size_t k = 0; k < adjusted.survey.terms().size(); ++k) {
        const adjustment::SurveyTerm& term = adjusted.survey.terms()[k];
        Coefficient& one = result.coefficients.emplace_back(
            Coefficient{term.name, adjusted.coefficient(k), std::nullopt, term.prior});
        if (noise.is_known)
            one.standard_error = std::sqrt(adjusted.adjustment.variance(
                {{adjusted.survey.unknown_of_term(k), 1.0}}, noise.ratio));
        if (term.is_scale)
            result.scales.push_back({term.instrument, one.value,
                                     one.standard_error.value_or(term.prior->sd), *term.prior});
    }
}

/// Sets value and uncertainty of a station that is an unknown.
void set_adjusted(StationValue& value, const Fit& result, const AdjustedSurvey& adjusted,
                  std::size_t station) {
    const adjustment::Adjustment& solution = adjusted.adjustment;
    const adjustment::EquationStation& of = adjusted.survey.stations()[station];
    value.is_flagged_only = false;
    value.gravity = adjusted.gravity(station);
    value.u_gravity = MilliGal(std::sqrt(solution.variance({{station, 1.0}})));
    if (const auto s0 = solution.s0())
        value.u_a_posteriori = MilliGal(*s0 * value.u_gravity->value());
    value.redundancy = of.datum_row ? solution.redundancy(*of.datum_row) : 0.0;
    for (const CorrectedRow& row : result.rows)
        if (row.is_used && row.row.site == value.site) {
            ++value.row_count;
            *value.redundancy += 1.0 - row.leverage.value();
        }
}

/// Sets value and uncertainty of a station that is the mean of its rows.
void set_mean(StationValue& value, const Fit& result, const AdjustedSurvey& adjusted,
              const RowChoice& choice, const Noise& noise) {
    std::vector<Combination> effects;
    double sum_mgal = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const CorrectedRow& row = result.rows[i];
        if (row.row.site != value.site || !adjusted.survey.loops()[i]) continue;
        if (row.is_used)
            value.redundancy = value.redundancy.value_or(0.0) + 1.0 - row.leverage.value();
        if (!value.is_flagged_only && !choice.accepted[i]) continue;
        effects.push_back(adjusted.survey.effects_as_unknowns(i));
        sum_mgal += (row.corrected - adjusted.survey.origin()).value();
        squares += std::pow(noise.ratio * adjusted.survey.sd_mgal(i), 2);
    }
    value.row_count = effects.size();
    const auto n = static_cast<double>(effects.size());
    value.gravity = adjusted.survey.origin() + MilliGal(sum_mgal / n);
    if (!noise.is_known) return;
    value.u_gravity = MilliGal(std::sqrt(
        squares / (n * n) + adjusted.adjustment.variance(sum_of(effects, 1.0 / n), noise.ratio)));
}

void set_stations(Fit& result, const AdjustedSurvey& adjusted, const RowChoice& choice,
                  const Noise& noise) {
    std::map<std::string, std::size_t> unknowns;
    for (std::size_t k = 0; k < adjusted.survey.stations().size(); ++k)
        unknowns.emplace(adjusted.survey.stations()[k].site, k);
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        if (!adjusted.survey.loops()[i]) continue;
        const auto [at, is_new] = places.emplace(row.site, result.stations.size());
        if (is_new) {
            StationValue& value = result.stations.emplace_back();
            value.site = row.site;
            value.reference = row.reference;
            value.is_flagged_only = true;
        }
        if (choice.accepted[i]) result.stations[at->second].is_flagged_only = false;
    }
    const auto dof = static_cast<double>(adjusted.adjustment.dof());
    for (StationValue& value : result.stations) {
        const auto unknown = unknowns.find(value.site);
        if (unknown != unknowns.end())
            set_adjusted(value, result, adjusted, unknown->second);
        else
            set_mean(value, result, adjusted, choice, noise);
        if (value.reference) value.residual = value.gravity - *value.reference;
        if (!adjusted.survey.design().is_exact || !(dof > 0.0)) continue;
        value.dof = dof;
        value.coverage_factor = signal::students_t_quantile(dof, 0.975);
    }
}

/// Means of the accepted rows of a station.
struct StationMean {
    StationValue* value = nullptr;
    std::vector<std::size_t> rows;
    MilliGal reading;  ///< acceleration - tide

    [[nodiscard]] double count() const { return static_cast<double>(rows.size()); }
    /// Returns the mean of the rows' terms.
    [[nodiscard]] Combination effects(const AdjustedSurvey& adjusted) const {
        std::vector<Combination> parts;
        for (const std::size_t row : rows)
            parts.push_back(adjusted.survey.effects_as_unknowns(row));
        return sum_of(parts, 1.0 / count());
    }
};

/// Returns the value of a combination of terms, mGal.
double value_of(const Combination& combination, const AdjustedSurvey& adjusted) {
    double sum = 0.0;
    for (const Entry& entry : combination)
        sum += entry.factor * adjusted.adjustment.value(entry.unknown);
    return sum;
}

}  // namespace

Fit fit_of(const AdjustedSurvey& adjusted, const SurveyProblem& problem, const RowChoice& choice) {
    const Noise noise = noise_of(adjusted);
    Fit result;
    result.rows = uncorrected(problem, choice);
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        result.rows[i].is_used = adjusted.survey.equation_of(i).has_value();
        if (!adjusted.survey.loops()[i]) continue;
        correct_row(result.rows[i], adjusted, i);
        judge_row(result.rows[i], adjusted, i, noise);
    }
    set_coefficients(result, adjusted, noise);
    set_stations(result, adjusted, choice, noise);
    return result;
}

void set_loo_interval(Fit& result, std::uint64_t seed) {
    if (!result.score.loo_mgal) return;
    std::vector<double> errors;
    std::vector<std::string> stations;
    for (const CorrectedRow& row : result.rows) {
        if (!row.is_used) continue;
        errors.push_back(row.residual->value() / (1.0 - row.leverage.value()));
        stations.push_back(row.row.site);
    }
    result.loo_interval_mgal = bootstrap_rms_interval(errors, stations, seed);
}

void set_left_out_stations(
    Fit& result, const AdjustedSurvey& adjusted, const RowChoice& choice,
    const std::function<AdjustedSurvey(const std::string&, const std::string&)>& without) {
    const auto s0 = adjusted.adjustment.s0();
    if (!s0) return;
    const double s_mgal = *s0 * adjusted.survey.knowledge().priors.reading_sd_mgal;
    std::vector<StationMean> means;
    for (StationValue& station : result.stations) {
        if (station.is_flagged_only) continue;
        StationMean& mean = means.emplace_back(StationMean{&station, {}, MilliGal(0.0)});
        for (std::size_t i = 0; i < result.rows.size(); ++i)
            if (result.rows[i].row.site == station.site && choice.accepted[i])
                mean.rows.push_back(i);
        for (const std::size_t i : mean.rows)
            mean.reading =
                mean.reading + MilliGal(result.rows[i].row.reduced().value() / mean.count());
    }
    StationCovariance covariance;
    for (std::size_t b = 0; b < means.size(); ++b) {
        const StationMean& to = means[b];
        const AdjustedSurvey of_one = without(to.value->site, "");
        if (of_one.is_determined() && !of_one.survey.readings().empty()) {
            const Combination x = to.effects(of_one);
            to.value->left_out = to.reading - MilliGal(value_of(x, of_one));
            to.value->u_left_out = MilliGal(
                std::sqrt(s_mgal * s_mgal / to.count() + of_one.adjustment.variance(x, *s0)));
        }
        covariance.sites.push_back(to.value->site);
        for (std::size_t a = 0; a < b; ++a) {
            const StationMean& from = means[a];
            const AdjustedSurvey of_two = without(from.value->site, to.value->site);
            if (!of_two.is_determined() || of_two.survey.readings().empty()) continue;
            Combination step = to.effects(of_two);
            for (Entry& entry : step) entry.factor = -entry.factor;
            step = sum_of({from.effects(of_two), step}, -1.0);
            result.differences.push_back(difference_of(
                *from.value, *to.value,
                to.reading - from.reading - MilliGal(value_of(step, of_two)),
                MilliGal(std::sqrt(s_mgal * s_mgal * (1.0 / from.count() + 1.0 / to.count()) +
                                   of_two.adjustment.variance(step, *s0)))));
        }
    }
    covariance.mgal2.resize(std::ssize(means), std::ssize(means));
    for (std::size_t b = 0; b < means.size(); ++b)
        for (std::size_t a = 0; a <= b; ++a) {
            const auto i = static_cast<Eigen::Index>(a), k = static_cast<Eigen::Index>(b);
            covariance.mgal2(i, k) = covariance.mgal2(k, i) =
                (a == b ? s_mgal * s_mgal / means[a].count() : 0.0) +
                adjusted.adjustment.covariance(means[a].effects(adjusted),
                                               means[b].effects(adjusted), *s0);
        }
    result.covariance = std::move(covariance);
}

void set_hidden_references(Fit& result, const AdjustedSurvey& adjusted) {
    const adjustment::Adjustment& solution = adjusted.adjustment;
    const auto& stations = adjusted.survey.stations();
    StationCovariance covariance;
    std::vector<std::pair<StationValue*, std::size_t>> unknowns;
    for (StationValue& value : result.stations) {
        const auto of = std::ranges::find(stations, value.site, &adjustment::EquationStation::site);
        if (of == stations.end()) continue;
        unknowns.emplace_back(&value, static_cast<std::size_t>(of - stations.begin()));
        value.left_out = value.gravity;
        value.u_left_out = value.u_gravity;
        if (!of->datum_row) continue;
        // The prediction without the row: reference + v / r, with the variance sd^2 (1 - r) / r.
        value.left_out.reset();
        value.u_left_out.reset();
        const double r = solution.redundancy(*of->datum_row);
        if (r < adjustment::kLeastRedundancy) continue;
        value.left_out = *value.reference + MilliGal(solution.residual(*of->datum_row) / r);
        value.u_left_out = MilliGal(of->u_held.value() * std::sqrt((1.0 - r) / r));
    }
    covariance.mgal2.resize(std::ssize(unknowns), std::ssize(unknowns));
    for (std::size_t b = 0; b < unknowns.size(); ++b) {
        const auto& [to, of_to] = unknowns[b];
        covariance.sites.push_back(to->site);
        for (std::size_t a = 0; a < unknowns.size(); ++a)
            covariance.mgal2(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) =
                solution.covariance({{of_to, 1.0}}, {{unknowns[a].second, 1.0}});
        for (std::size_t a = 0; a < b; ++a) {
            const auto& [from, of_from] = unknowns[a];
            result.differences.push_back(difference_of(
                *from, *to, to->gravity - from->gravity,
                MilliGal(std::sqrt(solution.variance({{of_to, 1.0}, {of_from, -1.0}})))));
        }
    }
    result.covariance = std::move(covariance);
}

}  // namespace a351::corrector::model
