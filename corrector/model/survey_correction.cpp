#include "corrector/model/survey_correction.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "corrector/model/model.hpp"
#include "corrector/model/outlier_tests.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

void require_row_of(const std::vector<reading::SurveyRow>& rows, const std::string& site,
                    const char* role) {
    const std::vector<std::string> known = station_names(rows);
    if (std::ranges::find(known, site) == known.end())
        throw InputError(fmt::format("{} = {}: no occupation of this site; allowed: {}", role, site,
                                     text::joined(known)));
}

RowChoice choose_rows(const std::vector<reading::SurveyRow>& rows,
                      const std::vector<std::string>& datum, bool use_flags) {
    RowChoice choice;
    for (const reading::SurveyRow& row : rows) {
        const bool is_datum =
            row.reference && (datum.empty() || std::ranges::find(datum, row.site) != datum.end());
        choice.accepted.push_back(!row.is_excluded && !(use_flags && row.is_flagged));
        choice.in_use.push_back(choice.accepted.back() && is_datum);
    }
    return choice;
}

/// A model, its fit, and how it was chosen.
struct Chosen {
    const Model* model = nullptr;
    FitResult fit;
    std::optional<Choice> choice;
    std::optional<double> choice_loso_mgal;
    std::vector<std::string> remarks;
};

Chosen choose_and_fit(const SurveyProblem& problem, const RowChoice& rows) {
    Chosen chosen;
    const SurveyOptions& options = problem.options;
    if (options.model != kAutomatic) {
        chosen.model = find_model(options.model);
        chosen.fit = chosen.model->fit(problem, rows);
        return chosen;
    }
    chosen.model = find_model(kWholeDay);
    chosen.fit = chosen.model->fit(problem, rows);
    const auto* const refusal = std::get_if<Refusal>(&chosen.fit);
    if (refusal == nullptr) return chosen;
    if (problem.day != nullptr)
        chosen.remarks.push_back("not the whole-day model: " + refusal->trouble);
    const std::vector<reading::SurveyRow> used = chosen_rows(problem.rows, rows.in_use);
    chosen.choice = choose_model(used, problem.origin(), options.base, options.priors);
    chosen.choice_loso_mgal =
        choice_loso_mgal(used, problem.origin(), options.base, options.priors);
    // With too few stations to compare models, the simplest one is taken, or its refusal.
    chosen.model =
        chosen.choice ? find_model(chosen.choice->model) : find_model(kLinearModels.front().name);
    chosen.fit = chosen.model->fit(problem, rows);
    return chosen;
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
    SurveyOptions applied = options;
    if (applied.base.empty()) applied.base = rows.front().site;
    require_row_of(rows, applied.base, "base");
    for (const std::string& site : applied.datum) require_row_of(rows, site, "datum");

    const SurveyProblem problem{rows, applied, day};
    const RowChoice unflagged = choose_rows(rows, applied.datum, true);
    const RowChoice all = choose_rows(rows, applied.datum, false);
    const RowChoice& in_fit = applied.use_flags ? unflagged : all;
    Chosen chosen = choose_and_fit(problem, in_fit);
    if (const auto* const refusal = std::get_if<Refusal>(&chosen.fit))
        throw InputError(fmt::format("model = {}: {}; allowed: {}", chosen.model->name,
                                     refusal->trouble, refusal->allowed));
    SurveyCorrection result;
    static_cast<Fit&>(result) = std::get<Fit>(std::move(chosen.fit));
    result.model = chosen.model->name;
    result.choice = chosen.choice;
    result.choice_loso_mgal = chosen.choice_loso_mgal;
    result.remarks.insert(result.remarks.begin(), chosen.remarks.begin(), chosen.remarks.end());

    const auto scores_of = [&](const char* name, const RowChoice& choice) {
        ScoredRowSet set{name, {}};
        const auto add = [&](const Model& model) {
            const auto score = &model == chosen.model && choice == in_fit
                                   ? result.score
                                   : model.score(problem, choice);
            if (score) set.scores.push_back(*score);
        };
        for (const Model& model : models())
            if (model.is_always_scored) add(model);
        if (!chosen.model->is_always_scored) add(*chosen.model);
        return set;
    };
    result.row_sets = {scores_of("used", unflagged), scores_of("all", all)};
    for (CorrectedRow& row : result.rows) row.doubt_physical = physical_doubt(row.row);
    result.options = std::move(applied);
    return result;
}

}  // namespace a351::corrector::model
