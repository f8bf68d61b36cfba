#include "corrector/model/survey_correction.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/model/linear_models.hpp"
#include "corrector/model/model.hpp"
#include "corrector/reading/refused.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

// `auto` compares linear models only with as many known stations.  Reason: with fewer, a left-out
// station says more about its own reading than about the model.
constexpr std::size_t kFewestComparedStations = 3;

void require_row_of(const std::vector<reading::SurveyRow>& rows, const std::string& site,
                    const char* role) {
    const std::vector<std::string> known = station_names(rows);
    if (std::ranges::find(known, site) == known.end())
        throw InputError(fmt::format("{} = {}: no occupation of this site; allowed: {}", role, site,
                                     text::joined(known)));
}

/// A model, its fit, and how it was chosen.
struct Chosen {
    const Model* model = nullptr;
    FitResult fit;
    std::optional<Choice> choice;
    std::optional<double> choice_loso_mgal;
    std::optional<adjustment::Priors>
        priors;  ///< Priors that were fitted, if not those of the options.
    std::vector<text::Message> remarks;
};

/// Returns the number of stations with a row in use.
std::size_t used_stations(const SurveyProblem& problem, const RowChoice& rows) {
    return station_names(problem.rows, rows.in_use).size();
}

/// Chooses one of the linear models; nullopt if the known stations are too few to compare them.
std::optional<Choice> choose_linear(const SurveyProblem& problem, const RowChoice& rows) {
    if (used_stations(problem, rows) < kFewestComparedStations) return std::nullopt;
    return choose_model(problem, rows.in_use);
}

/// Fits the chosen linear model; without a choice, the network with the published priors.
void fit_without_record(Chosen& chosen, const SurveyProblem& problem, const RowChoice& rows) {
    SurveyOptions options = problem.options;
    if (chosen.choice) {
        chosen.model = find_model(chosen.choice->model);
        chosen.choice_loso_mgal = choice_loso_mgal(problem, rows.in_use);
    } else {
        chosen.model = find_model(kNetwork);
        chosen.remarks.push_back(text::message(
            "{} readings at {} known stations do not allow to compare models: network, with the "
            "priors {}",
            std::ranges::count(rows.in_use, true), used_stations(problem, rows),
            adjustment::add_published_priors(options.priors)));
        chosen.priors = options.priors;
    }
    chosen.fit =
        chosen.model->fit({problem.rows, options, problem.day, nullptr, problem.temperature}, rows);
}

/// Comparison of the whole-day model with the linear model that `auto` would choose.
struct Comparison {
    bool is_linear_better = false;
    text::Message errors;  ///< Errors of both, in words.
};

/// Compares both models by the errors at stations left out; nullopt if these are not known.
///
/// Both errors of a row contain the same placement, so they are compared in pairs: the whole-day
/// model is worse if the 95 % interval of the mean difference of the squares, by station, is above
/// 0.  With few stations the interval is only a rough one.
std::optional<Comparison> compare_with_linear(const SurveyProblem& problem, const Fit& day,
                                              const std::optional<Choice>& choice,
                                              const RowChoice& rows) {
    const SurveyOptions& options = problem.options;
    if (!day.score.loso_mgal || !choice) return std::nullopt;
    const auto errors =
        left_out_errors_mgal(*find_linear_model(choice->model), problem, rows.in_use);
    if (!errors) return std::nullopt;
    std::vector<double> differences;
    std::vector<std::string> stations;
    double squares = 0.0;
    for (const CorrectedRow& row : day.rows) {
        if (!row.is_used) continue;
        const double linear = (*errors)[differences.size()];
        const MilliGal error = *row.row.reference - row.as<WholeDayRow>()->left_out.value();
        differences.push_back(error.value() * error.value() - linear * linear);
        stations.push_back(row.row.site);
        squares += linear * linear;
    }
    const auto interval = bootstrap_mean_interval(differences, stations, options.seed);
    return Comparison{
        interval && interval->low > 0.0,
        text::message(
            "its error at stations left out is {} mGal, that of {} is {} mGal",
            text::fixed(*day.score.loso_mgal, 2), choice->model,
            text::fixed(std::sqrt(squares / static_cast<double>(differences.size())), 2))};
}

/// Says that no other model was compared, and how the fit was tested.
text::Message without_comparison(const Fit& day) {
    const bool is_tested = !day.as<WholeDayPart>()->fit_tests.empty();
    return text::message(
        "model day; not compared with others (that needs enough readings at {} known stations); {}",
        kFewestComparedStations,
        is_tested ? text::message("its fit was tested at repeated and known stations")
                  : text::message("its fit could not be tested either"));
}

/// Returns true if the survey asks for the network and nothing that only the adjustment has.
bool is_plain_network(const SurveyOptions& options) {
    const NetworkOptions usual;
    return options.model == kNetwork && options.network.drift_degree == usual.drift_degree &&
           options.network.datum_sd_mgal == usual.datum_sd_mgal &&
           !options.network.fits_admittance && !options.priors.has_slope();
}

/// Gives stations whose reference no fit has seen their value as the one without it.
void value_stations_outside(Fit& result) {
    for (StationValue& station : result.stations) {
        const bool is_in_fit = std::ranges::any_of(result.rows, [&](const CorrectedRow& row) {
            return row.is_used && row.row.reference && row.row.site == station.site;
        });
        if (is_in_fit) continue;
        station.left_out = station.gravity;
        station.u_left_out = station.u_gravity;
    }
}

/// Says that a model takes references as exact that have an uncertainty.
void remark_unused_uncertainties(Fit& result, const Model& model) {
    const bool uses_them = model.name == kWholeDay || model.name == kNetwork;
    if (!uses_them && std::ranges::any_of(result.rows, [](const CorrectedRow& row) {
            return row.is_used && row.row.u_reference.value_or(MilliGal(0.0)).value() > 0.0;
        }))
        result.remarks.push_back(text::message(
            "{} takes the references as exact: their uncertainties in the table of sites are not "
            "used",
            model.name));
}

/// Says which priors and options of the user the model does not use.
void remark_unused(Fit& result, const Model& model, const SurveyOptions& options) {
    std::vector<std::string> used;
    for (const Coefficient& coefficient : result.coefficients)
        if (coefficient.prior) used.push_back(coefficient.name);
    for (const auto& scale : result.scales)
        used.push_back(adjustment::scale_name(scale.instrument));
    std::vector<std::string> unused = adjustment::unused_priors(options.priors, used);
    for (std::string& name : unused) name = "prior " + name;
    const NetworkOptions usual;
    if (result.as<NetworkPart>() == nullptr) {
        if (options.network.drift_degree != usual.drift_degree) unused.emplace_back("drift_degree");
        if (options.network.datum_sd_mgal != usual.datum_sd_mgal)
            unused.emplace_back("datum_sd_mgal");
    }
    if (!unused.empty())
        result.remarks.push_back(
            text::message("{} does not use: {}", model.name, text::joined(unused)));
}

/// Distance from the temperatures of the fit that is not worth a remark, degC.  Reason: it is twice
/// the swing of the oven, and 1.5 mGal at the published -29 mGal/degC.
constexpr double kOutsideTemperature_degc = 0.05;

/// Returns a remark on readings of unknown stations whose temperature is outside that of the
/// readings in the fit at known stations; empty if there are none, or if the rows have no temperature.
///
/// The temperature correction of such a reading is extrapolated: an error of the coefficient acts
/// on the whole distance.
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
        names.push_back(reading::stay_name(row.row.site, row.row.occupation));
    }
    if (names.empty()) return {};
    return text::message(
        "temperature outside {} to {} degC, that of the known stations in the fit, by up to {} "
        "degC: the temperature correction is extrapolated for {}",
        text::fixed(low_degc, 2), text::fixed(high_degc, 2), text::fixed(most_degc, 2),
        text::joined(names));
}

/// Returns true if the readings are of both faces, which only the whole-day model knows.
bool has_two_faces(const reading::DayRecord* day) {
    return day != nullptr && reading::has_two_faces(day->bins);
}

Chosen choose_and_fit(const SurveyProblem& problem, const RowChoice& rows) {
    Chosen chosen;
    const SurveyOptions& options = problem.options;
    const bool is_automatic = options.model == kAutomatic;
    if (has_two_faces(problem.day)) {
        chosen.model = find_model(is_automatic ? kWholeDay : options.model);
        chosen.fit = chosen.model->name == kWholeDay
                         ? chosen.model->fit(problem, rows)
                         : Refusal{text::message("the box was turned over, and this model knows "
                                                 "one face only"),
                                   "day"};
        return chosen;
    }
    if (!is_automatic && (problem.day == nullptr || !is_plain_network(options))) {
        chosen.model = find_model(options.model);
        chosen.fit = chosen.model->fit(problem, rows);
        return chosen;
    }
    chosen.model = find_model(kWholeDay);
    chosen.fit = chosen.model->fit(problem, rows);
    const std::optional<Choice> choice = is_automatic ? choose_linear(problem, rows) : std::nullopt;
    std::optional<text::Message> trouble;
    std::optional<Comparison> comparison;
    if (const auto* const refusal = std::get_if<Refusal>(&chosen.fit))
        trouble = refusal->trouble;
    else
        comparison = compare_with_linear(problem, std::get<Fit>(chosen.fit), choice, rows);
    if (comparison && comparison->is_linear_better) trouble = comparison->errors;
    if (!trouble) {
        chosen.remarks.push_back(
            !is_automatic
                ? text::message("network: the whole-day model is used, because it makes the same "
                                "adjustment and knows the temperature between the readings")
            : comparison ? text::message("the whole-day model is used: {}", comparison->errors)
                         : without_comparison(std::get<Fit>(chosen.fit)));
        return chosen;
    }
    if (problem.day != nullptr)
        chosen.remarks.push_back(text::message("not the whole-day model: {}", *trouble));
    if (is_automatic) {
        chosen.choice = choice;
        fit_without_record(chosen, problem, rows);
    } else {
        chosen.model = find_model(kNetwork);
        chosen.fit = chosen.model->fit(problem, rows);
    }
    return chosen;
}

/// Takes the network for readings of gravimeters, because it alone has a constant for each loop.
/// @throws InputError  another model is asked for, and there are several instruments or loops.
void choose_for_gravimeter(SurveyOptions& options, const std::vector<reading::SurveyRow>& rows) {
    const reading::SurveyRow& first = rows.front();
    if (first.instrument.empty()) return;
    if (options.model == kAutomatic) options.model = kNetwork;
    const bool has_loops = std::ranges::any_of(rows, [&](const reading::SurveyRow& row) {
        return row.instrument != first.instrument || row.loop != first.loop;
    });
    if (has_loops && options.model != kNetwork)
        throw InputError(
            fmt::format("model = {}: it has no constant for each instrument and loop; allowed: {}",
                        options.model, kNetwork));
}

}  // namespace

void add_left_out(SurveyCorrection& result, const std::vector<reading::LeftOut>& occupations) {
    auto& all = result.left_out;
    all.insert(all.end(), occupations.begin(), occupations.end());
    std::ranges::stable_sort(all, {}, &reading::LeftOut::start);
}

SurveyCorrection correct_survey(const std::vector<reading::SurveyRow>& rows,
                                const SurveyOptions& options, const reading::DayRecord* day) {
    if (options.model != kAutomatic && find_model(options.model) == nullptr)
        throw InputError(fmt::format("model = {}: unknown; allowed: {}", options.model,
                                     text::joined(model_names())));
    if (rows.empty()) throw InputError("no occupations; allowed: at least two with a reference");
    if (rows.size() == 1 && options.model == kAutomatic)
        throw reading::Refused("too_few_readings",
                               "one row, nothing to compare it with; allowed: at least 2 rows");
    SurveyOptions applied = options;
    if (applied.base.empty()) applied.base = rows.front().site;
    require_row_of(rows, applied.base, "base");
    for (const std::string& site : applied.datum) require_row_of(rows, site, "datum");
    choose_for_gravimeter(applied, rows);
    if (applied.network.fits_admittance && applied.model != kNetwork)
        throw InputError(fmt::format(
            "model = {}: it does not fit the admittance of the air pressure; allowed: {}",
            applied.model, kNetwork));

    SurveyProblem problem{rows, applied, day};
    if (day != nullptr) problem.temperature = std::make_shared<const whole_day::LaggedMeans>(*day);
    const RowChoice unflagged = choose_rows(rows, applied.datum, true);
    const RowChoice all = choose_rows(rows, applied.datum, false);
    const RowChoice& in_fit = applied.use_flags ? unflagged : all;
    Chosen chosen = choose_and_fit(problem, in_fit);
    if (const auto* const refusal = std::get_if<Refusal>(&chosen.fit))
        throw reading::Refused(
            std::ranges::count(in_fit.in_use, true) == 0 ? "no_reference" : "not_determined",
            fmt::format("model = {}: {}; allowed: {}", chosen.model->name, refusal->trouble,
                        refusal->allowed));
    SurveyCorrection result;
    static_cast<Fit&>(result) = std::get<Fit>(std::move(chosen.fit));
    value_stations_outside(result);
    remark_unused_uncertainties(result, *chosen.model);
    remark_unused(result, *chosen.model, applied);
    if (text::Message remark = temperature_remark(result.rows, applied.datum); !remark.empty())
        result.remarks.insert(result.remarks.begin(), std::move(remark));
    if (chosen.model->name == kPaper && !applied.steps.empty())
        result.remarks.push_back(
            text::message("paper does not know steps: those of the amendments are not used"));
    result.model = chosen.model->name;
    result.choice = chosen.choice;
    result.choice_loso_mgal = chosen.choice_loso_mgal;
    result.remarks.insert(result.remarks.begin(), chosen.remarks.begin(), chosen.remarks.end());

    const auto scores_of = [&](const char* name, const RowChoice& choice) {
        ScoredRowSet set{name, {}};
        SurveyOptions of_chosen = applied;
        if (chosen.priors) of_chosen.priors = *chosen.priors;
        const auto* const part = result.as<WholeDayPart>();
        const SurveyProblem fitted{rows, of_chosen, day, part != nullptr ? &part->point : nullptr,
                                   problem.temperature};
        const auto add = [&](const Model& model) {
            const auto score = &model != chosen.model ? model.score(problem, choice)
                               : choice == in_fit     ? result.score
                                                      : model.score(fitted, choice);
            if (score) set.scores.push_back(*score);
        };
        for (const Model& model : models())
            if (model.is_always_scored && !has_two_faces(day)) add(model);
        if (!chosen.model->is_always_scored) add(*chosen.model);
        return set;
    };
    result.row_sets = {scores_of("used", unflagged), scores_of("all", all)};
    if (chosen.priors) applied.priors = *chosen.priors;
    result.options = std::move(applied);
    return result;
}

}  // namespace a351::corrector::model
