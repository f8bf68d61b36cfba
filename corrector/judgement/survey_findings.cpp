#include "corrector/judgement/survey_findings.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "corrector/judgement/far_terms.hpp"
#include "corrector/judgement/mistake_search.hpp"
#include "corrector/judgement/mistake_sentences.hpp"
#include "corrector/judgement/physical_doubt.hpp"
#include "corrector/judgement/still_box.hpp"
#include "corrector/judgement/survey_remarks.hpp"
#include "corrector/judgement/unlike_neighbours.hpp"
#include "corrector/model/amended_survey.hpp"
#include "corrector/model/calibration_use.hpp"
#include "corrector/model/model.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/refused.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::judgement {
namespace {

using reading::Finding;
using reading::FindingKind;
using reading::SurveyRow;

/// A day is unusable if stations left out are predicted this much worse than with the mistakes put
/// right, and at least so badly.  Reason: twice the 2.6 mGal of the publication.
constexpr double kUnusableRatio = 2.0, kUnusable_mgal = 5.2;
/// Error with which a day is unusable whatever the cause, beyond what the references themselves are
/// uncertain by.  Reason: eight times the publication's error.
constexpr double kUnusableAnyhow_mgal = 20.0;

std::vector<SearchedReading> searched(const std::vector<SurveyRow>& rows,
                                      const model::RowChoice& choice, bool has_loops) {
    std::vector<SearchedReading> readings;
    const std::vector<std::size_t> loops = adjustment::loop_numbers(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        SearchedReading& reading = readings.emplace_back();
        if (has_loops) reading.loop = loops[i];
        reading.site = rows[i].site;
        reading.occupation = rows[i].occupation;
        reading.face = rows[i].face;
        reading.is_accepted = choice.accepted[i];
        if (choice.in_use[i]) reading.reference_mgal = rows[i].reference->value();
    }
    return readings;
}

/// Returns how the model does not fit the day.
Finding misfit(const whole_day::FitTest& test, const SurveyRow& row) {
    using whole_day::Misfit;
    Finding finding{.kind = FindingKind::misfit};
    finding.code =
        fmt::format("misfit_{}", whole_day::kMisfitNames.at(static_cast<std::size_t>(test.misfit)));
    const std::string stay = reading::stay_name(row.site, row.occupation);
    text::Message how;
    if (test.misfit == Misfit::curvature) {
        how = text::message("the residuals follow the square of the {}",
                            test.place == 0 ? text::message("temperature") : text::message("time"));
    } else {
        set_stay(finding, row);
        how = test.misfit == Misfit::step
                  ? text::message("the readings from {} on seem to be off by a step", stay)
                  : text::message("a few set-ups are much further off than the others, {} most",
                                  stay);
    }
    finding.text =
        text::message("the model does not fit this day: {} (p = {})", how, text::fixed(test.p, 4));
    return finding;
}

/// Adds a finding for each test that reports a misfit of the model to the day.
void say_misfits(const model::SurveyCorrection& result, std::vector<Finding>& findings) {
    const auto* const day = result.as<model::WholeDayPart>();
    if (day == nullptr) return;
    for (const whole_day::FitTest& test : day->fit_tests)
        if (test.is_misfit()) findings.push_back(misfit(test, result.rows[test.place].row));
}

/// Returns the place of a finding in the list: an unusable day, other headlines, mistakes, remarks,
/// what was not visited.
int rank_of(const Finding& finding) {
    if (finding.kind == FindingKind::unusable_day) return 0;
    if (finding.is_headline) return 1;
    if (!reading::is_remark(finding)) return 2;
    return finding.kind == FindingKind::not_visited ? 4 : 3;
}

/// Returns the rms uncertainty of the references.
double u_references(const model::SurveyCorrection& result) {
    std::vector<double> u_mgal;
    for (const model::CorrectedRow& row : result.rows)
        if (row.is_used && row.row.reference)
            u_mgal.push_back(row.row.u_reference.value_or(MilliGal(0.0)).value());
    return model::root_mean_square(u_mgal).value_or(0.0);
}

/// Says that the day is not usable, if so.
/// @param amended_loso_mgal  error of stations left out with the mistakes put right, if there are.
std::optional<Finding> unusable(const model::SurveyCorrection& result,
                                const std::optional<double>& amended_loso_mgal) {
    const auto& loso = result.score.loso_mgal;
    if (!loso) return std::nullopt;
    Finding finding{.kind = FindingKind::unusable_day, .code = "unusable_day", .is_headline = true};
    const bool is_bad_anyhow =
        new_station_errors_mgal(result).size() >= kFewestLeftOut &&
        amended_loso_mgal.value_or(*loso) > std::hypot(kUnusableAnyhow_mgal, u_references(result));
    if (!amended_loso_mgal && is_bad_anyhow)
        finding.text = text::message(
            "this day is not usable: stations left out are predicted with an error of {} mGal, and "
            "no mistake that is looked for explains it; check times, names, signs and units",
            text::fixed(*loso, 1));
    else if (amended_loso_mgal && *loso >= kUnusable_mgal &&
             (is_bad_anyhow || *loso >= kUnusableRatio * *amended_loso_mgal))
        finding.text = text::message(
            "this day is not usable as it is: stations left out are predicted "
            "with an error of {} mGal, {} with the mistakes that were found put right",
            text::fixed(*loso, 1), text::fixed(*amended_loso_mgal, 1));
    else
        return std::nullopt;
    return finding;
}

/// Trials that report how many there were.
class ReportedTrials final : public adjustment::Trials {
public:
    ReportedTrials(std::unique_ptr<adjustment::Trials> trials, const SearchedSurvey& survey)
        : trials_(std::move(trials)), survey_(survey) {}

    [[nodiscard]] std::shared_ptr<const adjustment::Residuals> residuals(
        const std::vector<adjustment::Alternative>& known,
        const std::vector<adjustment::Alternative>& quiet) override {
        // Without a mistake there are three rounds of six trials, and two of refinement.
        constexpr std::size_t kUsual = 21;
        if (survey_.progress) survey_.progress(done_, std::max(kUsual, done_ + 1));
        ++done_;
        return trials_->residuals(known, quiet);
    }
    void expect(const std::vector<std::vector<adjustment::Alternative>>& quiets) override {
        trials_->expect(quiets);
    }

private:
    std::unique_ptr<adjustment::Trials> trials_;
    const SearchedSurvey& survey_;
    std::size_t done_ = 0;
};

/// Findings of a survey, and the survey without its mistakes.
struct Search {
    std::vector<Finding> findings;
    std::vector<text::Message> remarks;
    std::optional<model::AmendedSurvey> amended;  ///< Absent if there are no mistakes.
};

/// Says which coefficients are far from their priors also without the mistakes, and which are not.
void say_far_terms(Search& found, const model::Model& model, const SearchedSurvey& survey,
                   const model::Fit& fit, const std::vector<model::Coefficient>& far,
                   const adjustment::Priors& given) {
    std::optional<model::FitResult> right;
    if (found.amended)
        right = model.fit({found.amended->rows, found.amended->options, survey.day},
                          found.amended->choice);
    const auto* const amended = right ? std::get_if<model::Fit>(&*right) : &fit;
    const std::vector<model::Coefficient> still =
        amended == nullptr ? std::vector<model::Coefficient>() : far_terms(*amended);
    for (const model::Coefficient& term : far) {
        const auto at = std::ranges::find(still, term.name, &model::Coefficient::name);
        if (at != still.end())
            found.findings.push_back(far_term(*amended, *at, given));
        else if (is_held(term, given))
            found.remarks.push_back(held_term(fit, term));
    }
}

/// @param far  coefficients far from their priors.  They are free while mistakes are searched, so
///             that nothing is a mistake that a scale explains; sizes are those with the priors.
/// @param given  priors of the user.
Search search(const model::SurveyCorrection& result, const SearchedSurvey& survey,
              const adjustment::Priors& given, const std::vector<model::Coefficient>& far = {}) {
    Search found{result.findings, {}, {}};
    std::vector<Finding>& findings = found.findings;
    std::optional<model::AmendedSurvey>& right = found.amended;
    std::optional<double> amended_loso_mgal;
    const model::Model& model = *model::find_model(result.model);
    const std::vector<SurveyRow> rows =
        model::without_known_tilt(survey.rows, result.options.calibration);
    const auto* const day = result.as<model::WholeDayPart>();
    const whole_day::SurveyPoint* const nearby = day != nullptr ? &day->point : nullptr;
    if (model.trials) {
        const model::RowChoice choice =
            model::choose_rows(rows, result.options.datum, result.options.use_flags);
        const double alpha =
            result.model == model::kWholeDay ? kWholeDayMistakeAlpha : kMistakeAlpha;
        const std::vector<SearchedReading> readings = searched(rows, choice, model.has_loops);
        model::SurveyOptions options = result.options;
        options.priors = freed(std::move(options.priors), far);
        std::vector<Mistake> mistakes;
        if (auto plain = model.trials({rows, options, survey.day, nearby}, choice)) {
            ReportedTrials trials(std::move(plain), survey);
            mistakes = search_mistakes(readings, trials, alpha);
        }
        if (!far.empty() && !mistakes.empty())
            if (const auto trials =
                    model.trials({rows, result.options, survey.day, nearby}, choice))
                drop_unclear(mistakes, readings, *trials, alpha);
        for (const Mistake& mistake : mistakes)
            for (Finding& finding : findings_of(mistake, readings, rows, choice, survey.sites))
                findings.push_back(std::move(finding));
        if (!mistakes.empty()) {
            right = model::amended(rows, result.options, {mistakes.begin(), mistakes.end()});
            if (const auto score =
                    model.score({right->rows, right->options, survey.day, nearby}, right->choice))
                amended_loso_mgal = score->loso_mgal;
        }
    }
    auto useless = still_box(survey.rows);
    if (!useless) useless = unusable(result, amended_loso_mgal);
    if (!right && !useless)
        for (Finding& finding : unlike_neighbours(result, survey.sites))
            findings.push_back(std::move(finding));
    if (useless) findings.push_back(std::move(*useless));
    if (auto finding = far_bias(result.rows)) findings.push_back(std::move(*finding));
    // A mistake that was found is a misfit of its own.
    if (!right) say_misfits(result, findings);
    for (Finding& remark : set_ups_not_lifted(survey.rows)) findings.push_back(std::move(remark));
    for (Finding& remark : survey_remarks(result, survey.rows, survey.sites))
        findings.push_back(std::move(remark));
    say_far_terms(found, model, survey, result, far, given);
    std::ranges::stable_sort(found.findings, {}, rank_of);
    return found;
}

/// Returns the network of these readings; nullopt if they do not determine it.
std::optional<model::SurveyCorrection> network_of(const std::vector<SurveyRow>& rows,
                                                  model::SurveyOptions options) {
    options.model = model::kNetwork;
    try {
        auto fit = model::correct_survey(rows, options, nullptr);
        if (fit.as<model::NetworkPart>() != nullptr) return fit;
    } catch (const reading::Refused&) {  // too few readings in a loop for this drift
    }
    return std::nullopt;
}

/// Says that with a drift of a higher degree in each loop at least three mistakes fewer are found, if
/// so.  Either may be the cause, so s0 of both fits is given.
/// @param right  the survey with the mistakes put right.
/// @param known  findings that were known before the search.
std::optional<Finding> curved_drift(const model::SurveyCorrection& result,
                                    const SearchedSurvey& survey, const model::AmendedSurvey& right,
                                    const std::vector<Finding>& known) {
    constexpr std::ptrdiff_t kFewestLess = 3;
    const auto mistakes = std::ranges::count_if(result.findings, is_searched_mistake);
    if (result.as<model::NetworkPart>() == nullptr || mistakes < kFewestLess) return std::nullopt;
    const auto s0_of = [](const std::optional<model::SurveyCorrection>& fit) {
        return text::fixed_or(fit ? fit->as<model::NetworkPart>()->s0() : std::nullopt, 2, "-");
    };
    const std::vector<SurveyRow> rows =
        model::without_known_tilt(survey.rows, result.options.calibration);
    model::SurveyOptions options = result.options;
    for (int& degree = ++options.network.drift_degree; degree <= model::kGreatestDriftDegree;
         ++degree) {
        std::optional<model::SurveyCorrection> curved = network_of(rows, options);
        if (!curved) continue;
        curved->findings = known;
        const auto found = std::ranges::count_if(
            find_mistakes(*curved, {survey.rows, survey.sites, nullptr}), is_searched_mistake);
        if (mistakes - found < kFewestLess) continue;
        return Finding{
            .kind = FindingKind::misfit,
            .code = "misfit_drift",
            .text = text::message(
                "with a drift of degree {} in each loop the number of mistakes is {} instead of "
                "{}; s0 is then {}, and {} with the mistakes put right: the drift may be curved",
                degree, found, mistakes, s0_of(curved),
                s0_of(network_of(right.rows, right.options)))};
    }
    return std::nullopt;
}

/// Returns the model that `auto` chooses without the mistakes; `present` if there is none.
std::string model_without_mistakes(const model::AmendedSurvey& right, const SearchedSurvey& survey,
                                   const std::string& present) {
    try {
        // The tilt of a calibration is subtracted from the amended rows already.
        return model::correct_survey(right.rows, right.options, survey.day).model;
    } catch (const reading::Refused&) {
        return present;
    }
}

}  // namespace

std::vector<double> new_station_errors_mgal(const model::SurveyCorrection& result) {
    const auto* const network = result.as<model::NetworkPart>();
    const auto is_held = [&](const std::string& site) {
        if (network != nullptr) return network->holds(site);
        return std::ranges::any_of(result.rows, [&](const model::CorrectedRow& row) {
            return row.is_used && row.row.reference && row.row.site == site;
        });
    };
    std::vector<double> errors_mgal;
    for (const model::StationValue& station : result.stations)
        if (station.left_out && station.reference && is_held(station.site))
            errors_mgal.push_back((*station.left_out - *station.reference).value());
    return errors_mgal;
}

std::vector<Finding> find_mistakes(const model::SurveyCorrection& result,
                                   const SearchedSurvey& survey) {
    return search(result, survey, result.options.priors).findings;
}

model::SurveyCorrection correct_and_search(const SearchedSurvey& survey,
                                           model::SurveyOptions options,
                                           const std::vector<Finding>& known) {
    const auto correct = [&] {
        auto result = model::correct_with_calibration(survey.rows, options, survey.day);
        result.findings = known;
        return result;
    };
    bool has_far_terms = false;
    const auto search_and_hold = [&](model::SurveyCorrection& result) {
        std::vector<model::Coefficient> far = far_terms(result);
        has_far_terms = !far.empty();
        Search found = search(result, survey, options.priors, far);
        if (far.empty()) return found;
        model::SurveyCorrection fit;
        // A coefficient that is held can push another one away from its prior.  Mistakes may be the
        // cause instead; they are put right first.
        for (std::size_t held_count = 0; held_count != far.size();) {
            held_count = far.size();
            model::SurveyOptions with_held = options;
            with_held.priors = held(options.priors, far);
            fit = model::correct_with_calibration(survey.rows, with_held, survey.day);
            if (found.amended) break;
            for (const model::Coefficient& term : far_terms(fit)) {
                if (std::ranges::count(far, term.name, &model::Coefficient::name) > 0) continue;
                found.findings.push_back(far_term(fit, term, options.priors));
                far.push_back(term);
            }
        }
        std::ranges::stable_sort(found.findings, {}, rank_of);
        fit.remarks.insert(fit.remarks.end(), found.remarks.begin(), found.remarks.end());
        result = std::move(fit);
        return found;
    };
    model::SurveyCorrection result = correct();
    Search found = search_and_hold(result);
    if (options.model == model::kAutomatic && result.model != model::kWholeDay) {
        // The mistakes may be the reason why the whole-day model looks worse; it sees more of them.
        model::SurveyCorrection of_day = result;
        of_day.model = model::kWholeDay;
        std::optional<model::AmendedSurvey> right;
        if (survey.day != nullptr) right = search(of_day, survey, options.priors).amended;
        if (!right) right = found.amended;
        const std::string chosen =
            right ? model_without_mistakes(*right, survey, result.model) : result.model;
        if (chosen != result.model) {
            options.model = chosen;
            result = correct();
            result.remarks.push_back(text::message(
                "{} is chosen from the readings without the mistakes that were found", chosen));
            found = search_and_hold(result);
        }
    }
    result.findings = std::move(found.findings);
    if (found.amended && !has_far_terms)
        if (auto finding = curved_drift(result, survey, *found.amended, known)) {
            result.findings.push_back(std::move(*finding));
            std::ranges::stable_sort(result.findings, {}, rank_of);
        }
    for (model::CorrectedRow& row : result.rows) row.doubt_physical = physical_doubt(row.row);
    return result;
}

}  // namespace a351::corrector::judgement
