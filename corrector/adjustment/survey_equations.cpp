#include "corrector/adjustment/survey_equations.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "protocol/core/units.hpp"

namespace a351::corrector::adjustment {
namespace {

using reading::SurveyRow;

/// Least standard deviation of a reading or a reference, mGal; see prior.hpp.
MilliGal at_least_resolution(MilliGal sd) { return MilliGal(std::max(sd.value(), kLeastSd_mgal)); }

std::string numbered(std::string_view name, std::string_view of, std::size_t number) {
    return number == 0 ? std::string(name) : fmt::format("{}_{}{}", name, of, number + 1);
}

/// Returns the numbers of the loops that have a reading in use; others have none.
std::vector<std::optional<std::size_t>> used_loops(const std::vector<SurveyRow>& rows,
                                                   const std::vector<bool>& in_use,
                                                   std::size_t& count) {
    const std::vector<std::size_t> all = loop_numbers(rows);
    std::vector<bool> is_used(rows.size(), false);
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (in_use[i]) is_used[all[i]] = true;
    std::vector<std::optional<std::size_t>> numbers(rows.size()), loops;
    for (std::size_t loop = 0; loop < rows.size(); ++loop)
        if (is_used[loop]) numbers[loop] = count++;
    for (const std::size_t loop : all) loops.push_back(numbers[loop]);
    return loops;
}

}  // namespace

std::vector<std::size_t> loop_numbers(const std::vector<SurveyRow>& rows) {
    std::map<std::string, std::size_t> last_of;
    std::vector<std::size_t> loops;
    std::size_t count = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto last = last_of.find(rows[i].instrument);
        const bool continues = last != last_of.end() && rows[last->second].loop == rows[i].loop &&
                               seconds_between(rows[last->second].time, rows[i].time) <=
                                   kLoopPause_h * kSecondsPerHour;
        loops.push_back(continues ? loops[last->second] : count++);
        last_of[rows[i].instrument] = i;
    }
    return loops;
}

SurveyEquations::SurveyEquations(const std::vector<SurveyRow>& rows, std::vector<bool> in_use,
                                 Design design, SurveyKnowledge knowledge)
    : rows_(&rows),
      in_use_(std::move(in_use)),
      design_(std::move(design)),
      knowledge_(std::move(knowledge)),
      origin_(kMilliGalPerStandardGravity),
      equation_of_(rows.size()),
      effects_(rows.size()) {
    set_stations();
    set_loops();
    set_terms();
    set_effects();
    linearise(std::map<std::string, MilliGal>());
}

void SurveyEquations::set_stations() {
    std::map<std::string, std::size_t> numbers;
    for (std::size_t i = 0; i < rows_->size(); ++i) {
        if (!in_use_[i]) continue;
        const SurveyRow& row = (*rows_)[i];
        equation_of_[i] = readings_.size();
        ReadingRow& reading = readings_.emplace_back(ReadingRow{i});
        if (design_.is_exact) continue;
        const auto [at, is_new] = numbers.emplace(row.site, stations_.size());
        reading.station = at->second;
        if (!is_new) continue;
        EquationStation& station = stations_.emplace_back(EquationStation{row.site});
        if (!row.is_datum(knowledge_.datum)) continue;
        station.held = row.reference;
        station.u_held = at_least_resolution(row.u_reference.value_or(knowledge_.sd_of_reference));
    }
    std::size_t next = readings_.size();
    bool is_first = true;
    for (EquationStation& station : stations_) {
        if (!station.held) continue;
        if (is_first) origin_ = *station.held;
        is_first = false;
        station.datum_row = next++;
    }
}

void SurveyEquations::set_loops() {
    if (design_.has_loops) {
        loops_ = used_loops(*rows_, in_use_, loop_count_);
    } else {
        loops_.assign(rows_->size(), std::size_t{0});
        loop_count_ = 1;
    }
    origins_.resize(loop_count_);
    for (std::size_t i = 0; i < rows_->size(); ++i)
        if (loops_[i] && !origins_[*loops_[i]]) origins_[*loops_[i]] = (*rows_)[i].time;
}

void SurveyEquations::set_terms() {
    const auto add = [this](const Term& term, std::string name) {
        const Prior* const prior = knowledge_.priors.find(term.name);
        terms_.push_back({std::move(name), term.correction,
                          prior == nullptr ? std::nullopt : std::optional(*prior)});
    };
    const auto is_of_loop = [this](const Term& term) {
        return design_.has_loops && term.scope == Scope::loop;
    };
    for (std::size_t loop = 0; loop < loop_count_; ++loop)
        for (const Term* const term : design_.terms)
            if (is_of_loop(*term)) add(*term, numbered(term->name, "loop", loop));
    for (const Term* const term : design_.terms)
        if (!is_of_loop(*term) && term->column != nullptr) add(*term, std::string(term->name));
}

void SurveyEquations::set_effects() {
    const auto is_of_loop = [this](const Term& term) {
        return design_.has_loops && term.scope == Scope::loop;
    };
    const auto each_loop = static_cast<std::size_t>(
        std::ranges::count_if(design_.terms, [&](const Term* term) { return is_of_loop(*term); }));
    for (std::size_t i = 0; i < rows_->size(); ++i) {
        if (!loops_[i]) continue;
        const SurveyRow& row = (*rows_)[i];
        const double hours =
            seconds_between(*origins_[*loops_[i]], row.time) / kSecondsPerHour - kReferenceTime_h;
        std::size_t of_loop = *loops_[i] * each_loop, of_survey = loop_count_ * each_loop;
        for (const Term* const term : design_.terms)
            if (term->column != nullptr)
                effects_[i].push_back({is_of_loop(*term) ? of_loop++ : of_survey++,
                                       term->column({row, hours, design_.name})});
    }
    add_steps();
    if (std::ranges::find(design_.terms, &kScaleTerm) != design_.terms.end()) {
        for (std::size_t i = 0; i < rows_->size(); ++i) {
            const std::string& instrument = (*rows_)[i].instrument;
            if (!loops_[i] || scale_of((*rows_)[i])) continue;
            const auto count =
                static_cast<std::size_t>(std::ranges::count(terms_, true, &SurveyTerm::is_scale));
            terms_.push_back({numbered(kScale, "instrument", count), Correction::scale,
                              knowledge_.priors.scale_of(instrument), true, instrument});
        }
        for (std::size_t i = 0; i < rows_->size(); ++i)
            if (loops_[i]) effects_[i].push_back({*scale_of((*rows_)[i]), 0.0});
    }
    scales_.assign(terms_.size(), 1.0);
}

void SurveyEquations::add_steps() {
    for (std::size_t k = 0; k < knowledge_.steps.size(); ++k) {
        const Step& step = knowledge_.steps[k];
        const auto after =
            std::ranges::find_if(*rows_, [&](const SurveyRow& row) { return step.is_before(row); });
        constexpr std::size_t kNone = SIZE_MAX;
        const std::size_t loop =
            after == rows_->end()
                ? kNone
                : loops_[static_cast<std::size_t>(after - rows_->begin())].value_or(kNone);
        const auto is_of_loop = [&](std::size_t i) {
            return loops_[i].value_or(kNone - 1) == loop;
        };
        const auto is_stepped = [&](std::size_t i) {
            return is_of_loop(i) && step.is_before((*rows_)[i]);
        };
        bool is_seen_before = false, is_seen_after = false;
        for (std::size_t i = 0; i < rows_->size(); ++i)
            if (in_use_[i] && is_of_loop(i))
                (is_stepped(i) ? is_seen_after : is_seen_before) = true;
        // A step that a loop does not see has no coefficient; a linear model refuses it.
        if (design_.has_loops && !(is_seen_before && is_seen_after)) continue;
        for (std::size_t i = 0; i < rows_->size(); ++i)
            if (is_stepped(i)) effects_[i].push_back({terms_.size(), 1.0});
        terms_.push_back({fmt::format("step_{}_mgal", k + 1), Correction::drift});
    }
}

std::optional<std::size_t> SurveyEquations::scale_of(const SurveyRow& row) const {
    const auto at = std::ranges::find_if(terms_, [&](const SurveyTerm& term) {
        return term.is_scale && term.instrument == row.instrument;
    });
    if (at == terms_.end()) return std::nullopt;
    return static_cast<std::size_t>(at - terms_.begin());
}

Combination SurveyEquations::effects_as_unknowns(std::size_t row) const {
    Combination unknowns = effects_[row];
    for (Entry& entry : unknowns) entry.unknown += stations_.size();
    return unknowns;
}

double SurveyEquations::sd_mgal(std::size_t row) const {
    const double reading_mgal = knowledge_.priors.reading_sd_mgal;
    return noise_ * (design_.is_exact ? reading_mgal
                                      : std::hypot(reading_mgal, (*rows_)[row].u_average.value()));
}

Equations SurveyEquations::equations() const {
    Equations equations{stations_.size(), terms_.size(), {}};
    for (const ReadingRow& reading : readings_) {
        const SurveyRow& row = (*rows_)[reading.row];
        Equation& equation = equations.rows.emplace_back();
        equation.sd = sd_mgal(reading.row);
        equation.unknowns = effects_as_unknowns(reading.row);
        if (!reading.station) {
            equation.value = (row.acceleration - *row.reference - row.tide).value();
            continue;
        }
        equation.value = (row.acceleration - origin_ - row.tide).value();
        double of_station = 1.0;
        for (const Entry& entry : effects_[reading.row]) {
            if (!terms_[entry.unknown].is_scale) continue;
            of_station = scales_[entry.unknown];
            equation.value += entry.factor * (of_station - 1.0);
        }
        equation.unknowns.push_back({unknown_of_station(*reading.station), of_station});
    }
    for (std::size_t k = 0; k < stations_.size(); ++k)
        if (stations_[k].held)
            equations.rows.push_back({(*stations_[k].held - origin_).value(),
                                      stations_[k].u_held.value(),
                                      {{unknown_of_station(k), 1.0}},
                                      false});
    for (const bool is_scale : {true, false})
        for (std::size_t k = 0; k < terms_.size(); ++k) {
            const SurveyTerm& term = terms_[k];
            if (!term.prior || term.is_scale != is_scale) continue;
            const double sd = knowledge_.priors.in_use(term.name, *term.prior).sd;
            equations.rows.push_back({term.prior->mean - (is_scale ? 1.0 : 0.0),
                                      sd,
                                      {{unknown_of_term(k), 1.0}},
                                      false,
                                      std::max(1.0, term.prior->sd / sd)});
        }
    return equations;
}

std::vector<std::string> SurveyEquations::labels() const {
    std::vector<std::string> labels;
    for (const ReadingRow& reading : readings_)
        labels.push_back(
            reading::stay_name((*rows_)[reading.row].site, (*rows_)[reading.row].occupation));
    for (const EquationStation& station : stations_)
        if (station.held) labels.push_back("datum " + station.site);
    for (const bool is_scale : {true, false})
        for (const SurveyTerm& term : terms_)
            if (term.prior && term.is_scale == is_scale) labels.push_back("prior " + term.name);
    return labels;
}

bool SurveyEquations::is_nonlinear() const {
    return !design_.is_exact &&
           std::ranges::find(terms_, true, &SurveyTerm::is_scale) != terms_.end();
}

void SurveyEquations::linearise(const Adjustment& solution) {
    std::vector<double> gravities_mgal, coefficients;
    for (std::size_t k = 0; k < stations_.size(); ++k) gravities_mgal.push_back(solution.value(k));
    for (std::size_t k = 0; k < terms_.size(); ++k)
        coefficients.push_back(solution.value(unknown_of_term(k)));
    set_gravity_columns(gravities_mgal, coefficients);
}

void SurveyEquations::linearise(const std::map<std::string, MilliGal>& gravities) {
    std::vector<double> gravities_mgal, coefficients(terms_.size());
    for (const EquationStation& station : stations_) {
        const auto known = gravities.find(station.site);
        gravities_mgal.push_back(known == gravities.end() ? 0.0
                                                          : (known->second - origin_).value());
    }
    for (std::size_t k = 0; k < terms_.size(); ++k)
        if (terms_[k].is_scale) coefficients[k] = terms_[k].prior->mean - 1.0;
    set_gravity_columns(gravities_mgal, coefficients);
}

void SurveyEquations::set_gravity_columns(const std::vector<double>& gravities_mgal,
                                          const std::vector<double>& coefficients) {
    for (std::size_t k = 0; k < terms_.size(); ++k)
        if (terms_[k].is_scale) scales_[k] = 1.0 + coefficients[k];
    std::map<std::string, double> known;
    for (std::size_t k = 0; k < stations_.size(); ++k)
        known.emplace(stations_[k].site, gravities_mgal[k]);
    for (std::size_t i = 0; i < rows_->size(); ++i) {
        const SurveyRow& row = (*rows_)[i];
        if (effects_[i].empty() || !terms_[effects_[i].back().unknown].is_scale) continue;
        Entry& scale = effects_[i].back();
        if (design_.is_exact && in_use_[i]) {
            scale.factor = (*row.reference - origin_).value();
            continue;
        }
        const auto station = known.find(row.site);
        if (station != known.end()) {
            scale.factor = station->second;
            continue;
        }
        // reading - effects = g0 + S (g - g0)
        double left_mgal = (row.acceleration - row.tide - origin_).value();
        for (const Entry& entry : effects_[i])
            if (!terms_[entry.unknown].is_scale)
                left_mgal -= entry.factor * coefficients[entry.unknown];
        scale.factor = left_mgal / scales_[scale.unknown];
    }
}

double AdjustedSurvey::coefficient(std::size_t term) const {
    return adjustment.value(survey.unknown_of_term(term)) +
           (survey.terms()[term].is_scale ? 1.0 : 0.0);
}

AdjustedSurvey adjust(SurveyEquations survey, Cofactor cofactor) {
    constexpr double kRounding_mgal = 1e-9;  // with 1000 stations rounding alone moves 4e-10
    double moved_mgal = 0.0;
    Adjustment solution(survey.equations(), Cofactor::left_out);
    for (int round = 1; solution.undetermined().empty() && round < kScaleRounds; ++round) {
        survey.linearise(solution);
        if (!survey.is_nonlinear()) break;
        Adjustment next(survey.equations(), Cofactor::left_out);
        if (!next.undetermined().empty()) {
            solution = std::move(next);
            break;
        }
        moved_mgal = 0.0;
        for (std::size_t k = 0; k < survey.stations().size(); ++k)
            moved_mgal = std::max(moved_mgal, std::abs(next.value(k) - solution.value(k)));
        solution = std::move(next);
        if (moved_mgal < kRounding_mgal) break;
    }
    if (cofactor == Cofactor::computed) solution.compute_cofactor();
    return {std::move(survey), std::move(solution), moved_mgal};
}

}  // namespace a351::corrector::adjustment
