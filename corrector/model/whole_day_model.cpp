#include "corrector/model/whole_day_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "corrector/archive_series/on_all_cores.hpp"
#include "corrector/model/adjusted_day.hpp"
#include "corrector/model/amended_survey.hpp"
#include "corrector/model/calibration_use.hpp"
#include "corrector/whole_day/goodness_of_fit.hpp"
#include "corrector/whole_day/set_up_residuals.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::model {
namespace {

constexpr double kLongestGap_s = 21600.0;  // a longer pause begins another survey day
constexpr double kWantedLead_s = 7200.0;   // several slow lags
constexpr double kNotableShare = 0.25;     // of a variance: half of a standard deviation
constexpr double kNotableGap_s = 300.0;    // together less than a ninth of the slow lag

Score score_of(const std::vector<reading::SurveyRow>& rows, const std::vector<bool>& in_use,
               const AdjustedDay& day) {
    Score score;
    score.model = kWholeDay;
    score.parameter_count = whole_day::kDayTerms;
    double in_sample = 0.0, left_out = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i]) continue;
        ++score.row_count;
        const double reference = rows[i].reference->value();
        in_sample += std::pow(reference - day.fit().set_ups[i].corrected.value(), 2);
        if (const AdjustedDay::Without* const other = day.without(i))
            left_out += std::pow(reference - other->adjustment->corrected(i).value(), 2);
    }
    score.dof = score.row_count - std::min(score.row_count, score.parameter_count);
    const auto n = static_cast<double>(score.row_count);
    score.rms_mgal = std::sqrt(in_sample / n);
    if (day.is_any_left_out()) score.loso_mgal = std::sqrt(left_out / n);
    return score;
}

/// Returns the uncertainty of a row whose station is unknown: u^2 = (standard error of the
/// station)^2 + placement^2 (1 - 1/count).  The second part is the difference between the row's own
/// placement error and the mean over the `count` set-ups that share the unknown.
MilliGal row_uncertainty(const AdjustedDay& day, std::size_t row) {
    double count = 0.0;
    for (const whole_day::DayStation& station : day.survey().stations)
        if (station.number == day.number_of(row)) count += 1.0;
    const double own = day.without(row)->adjustment->expected_noise().placement_mgal *
                       std::sqrt(1.0 - 1.0 / count);
    return MilliGal(std::hypot(day.without(row)->gravity.standard_error, own));
}

/// Returns the sum of the samples' durations: least spacing times number of samples.
double duration_s(const std::vector<UtcTime>& times) {
    double spacing_s = seconds_between(times[0], times[1]);
    for (std::size_t i = 2; i < times.size(); ++i)
        spacing_s = std::min(spacing_s, seconds_between(times[i - 1], times[i]));
    return spacing_s * static_cast<double>(times.size());
}

void correct_row(CorrectedRow& out, std::size_t i, const AdjustedDay& day,
                 const std::vector<UtcTime>& averaged) {
    const whole_day::DaySetUp& set_up = day.fit().set_ups[i];
    out.row.start = averaged.front();
    out.row.end = averaged.back();
    out.row.acceleration = set_up.reading;
    out.row.tide = set_up.tide;
    out.row.temperature = set_up.temperature;
    for (std::size_t k = 0; k < whole_day::kDayTerms; ++k)
        out.subtract(whole_day::kDayTermList.at(k)->correction, MilliGal(set_up.effect_mgal.at(k)));
    out.corrected = set_up.corrected;
    auto& own =
        out.own.emplace<WholeDayRow>(WholeDayRow{.averaged_s = duration_s(averaged),
                                                 .fast_rate_degc_per_h = set_up.rate_degc_per_h,
                                                 .flicker_correction = -set_up.flicker,
                                                 .left_out = std::nullopt});
    if (out.row.reference) {
        out.difference = out.row.acceleration - *out.row.reference - out.row.tide;
        out.residual = out.corrected - *out.row.reference;
    }
    // The values that the row has if its reference is unknown.
    const AdjustedDay::Without* const other = day.without(i);
    if (other == nullptr) return;
    out.u_corrected = row_uncertainty(day, i);
    if (!out.row.reference) return;
    own.left_out = other->adjustment->corrected(i);
    const double u_reference_mgal = out.row.u_reference.value_or(MilliGal(0.0)).value();
    out.studentised_residual = (*own.left_out - *out.row.reference).value() /
                               std::hypot(out.u_corrected->value(), u_reference_mgal);
}

/// Returns the standard deviation of rA + rS: the response to a steady temperature.
double slope_deviation(const whole_day::DayPriors& priors,
                       const whole_day::DayPriors::Matrix& covariance) {
    const whole_day::DayPriors::Vector sum =
        (priors.factor.row(whole_day::DayPriors::place_of(whole_day::DayTerm::level)) +
         priors.factor.row(whole_day::DayPriors::place_of(whole_day::DayTerm::slow)))
            .transpose();
    return std::sqrt(sum.dot(covariance * sum));
}

/// Adds remarks on the part of the priors and on gaps of the temperature.
void remark_sources(Fit& result, const whole_day::DayFit& fit, const whole_day::DayPriors& priors,
                    bool is_calibrated, const reading::DayTemperature& temperature) {
    const double prior = slope_deviation(priors, whole_day::DayPriors::Matrix::Identity());
    const double posterior = slope_deviation(priors, fit.shift_covariance);
    // The variance that is left, of the prior's: the share that no reading has determined.
    const double share = posterior * posterior / (prior * prior);
    if (!is_calibrated && share > kNotableShare)
        result.remarks.push_back(text::message(
            "the slope for a steady temperature is {} % prior: the readings at known stations "
            "determine it little (standard error {} mGal/degC, of the prior alone {})",
            std::lround(100.0 * share), text::fixed(posterior, 1), text::fixed(prior, 1)));
    double missing_s = 0.0;
    for (const reading::TemperatureGap& gap : temperature.gaps)
        missing_s +=
            static_cast<double>(gap.after - gap.before - 1) / temperature.series.rate().value();
    if (missing_s >= kNotableGap_s)
        result.remarks.push_back(text::message(
            "{} min of the temperature are missing, the longest gap has {}; the effect of a gap on "
            "later readings is estimated, and u includes its uncertainty, provided that the sensor "
            "stayed powered",
            std::lround(missing_s / 60.0), std::lround(temperature.longest_gap_s() / 60.0)));
}

/// Adds which set-ups were turned over, and whether that pays.
void remark_faces(Fit& result, const whole_day::DayFit& fit) {
    if (!fit.scale_share) return;
    // From this share on + - - + is less than a tenth better than four set-ups in one face (tests/bench/faces_bound.py),
    // the least gain for which a design proposes it.
    constexpr double kShareOfLeastGain = 0.75;
    const auto turned = std::ranges::count_if(result.rows, [&](const CorrectedRow& one) {
        return one.row.face != result.rows.front().row.face;
    });
    const double share = fit.scale_share->value, u = fit.scale_share->standard_error;
    text::Message remark = text::message(
        "{} of {} set-ups were turned over; {} +- {} % of the errors are of the scale, which "
        "turning does not cancel",
        turned, result.rows.size(), std::lround(100.0 * share), std::lround(100.0 * u));
    if (share + 2.0 * u < kShareOfLeastGain)
        remark = remark + text::message(": turning pays on this unit");
    if (share - 2.0 * u > kShareOfLeastGain)
        remark = remark + text::message(": turning does not pay on this unit");
    result.remarks.push_back(std::move(remark));
}

/// Enlarges the uncertainties of stations and differences if the model does not fit the day and the
/// readings that were left out scatter more than stated.
void check_fit(Fit& result, const std::vector<whole_day::FitTest>& tests) {
    auto& part = std::get<WholeDayPart>(result.own);
    part.fit_tests = tests;
    if (tests.empty())
        result.remarks.push_back(text::message(
            "too few readings of known or repeated stations to test whether the model fits the "
            "day"));
    if (std::ranges::none_of(tests, &whole_day::FitTest::is_misfit)) return;
    double squares = 0.0, count = 0.0;
    for (const CorrectedRow& row : result.rows) {
        if (!row.is_used || !row.studentised_residual) continue;
        squares += std::pow(*row.studentised_residual, 2);
        count += 1.0;
    }
    if (count == 0.0) {
        result.remarks.push_back(text::message(
            "the model does not fit this day, and no reading could be left out, so the "
            "uncertainties are unchecked"));
        return;
    }
    constexpr double kNotable = 1.01;  // less would be printed as 1.00
    const double factor = std::sqrt(squares / count);
    if (factor <= kNotable) return;
    part.uncertainty_factor = factor;
    enlarge_uncertainties(result, factor);
    result.remarks.push_back(
        text::message("the model does not fit this day, so the uncertainties of stations and "
                      "differences are enlarged by {}",
                      text::fixed(factor, 2)));
}

std::optional<text::Message> refusal_of(const SurveyProblem& problem, const RowChoice& choice) {
    auto refusal = day_refusal(problem.rows, choice.in_use, problem.day);
    if (!refusal && problem.options.priors.has_slope())
        refusal = text::message("uses its own priors, `prior` would be ignored");
    return refusal;
}

std::optional<Score> score_day(const SurveyProblem& problem, const RowChoice& choice) {
    if (refusal_of(problem, choice)) return std::nullopt;
    return score_of(problem.rows, choice.in_use,
                    adjusted_day(problem, choice, day_priors_of(problem.options)));
}

FitResult fit_whole_day(const SurveyProblem& problem, const RowChoice& choice) {
    if (const auto refusal = refusal_of(problem, choice)) return Refusal{*refusal, "another model"};
    const std::vector<reading::SurveyRow>& rows = problem.rows;
    const SurveyOptions& options = problem.options;
    const reading::DayRecord& day = *problem.day;
    const whole_day::DayPriors priors = day_priors_of(options);
    const AdjustedDay adjusted = adjusted_day(problem, choice, priors);
    Fit result;
    WholeDayPart part;
    part.unit = whole_day::unit_posterior(adjusted.fit(), priors);
    part.point = adjusted.fit().point;
    result.own = std::move(part);
    result.rows = uncorrected(problem, choice);
    result.score = score_of(rows, choice.in_use, adjusted);
    std::vector<std::vector<UtcTime>> averaged(rows.size());  // times of the samples in the bins
    for (const reading::DayBin& bin : day.bins)
        averaged[bin.set_up].insert(averaged[bin.set_up].end(), bin.times.begin(), bin.times.end());
    for (std::size_t i = 0; i < rows.size(); ++i)
        correct_row(result.rows[i], i, adjusted, averaged[i]);
    result.coefficients = coefficients_of(adjusted.fit());
    const auto factor = priors.factor_in(reading::has_two_faces(day.bins));
    for (std::size_t k = 0; k < whole_day::kDayTerms; ++k) {
        const adjustment::Term& term = *whole_day::kDayTermList.at(k);
        // Nothing is known of the constant, and the day decides the size of the axis biases.
        if (&term == &adjustment::kConstant || term.correction == adjustment::Correction::tilt)
            continue;
        const auto at = whole_day::DayPriors::place_of(static_cast<whole_day::DayTerm>(k));
        const double without_effect = &term == &adjustment::kScaleTerm ? 1.0 : 0.0;
        result.coefficients[k].prior =
            adjustment::Prior{priors.mean(at) + without_effect, factor.row(at).norm()};
    }
    const auto place = whole_day::DayPriors::place_of(whole_day::DayTerm::scale);
    const whole_day::Estimate& scale =
        adjusted.fit().coefficients.at(static_cast<std::size_t>(whole_day::DayTerm::scale));
    result.scales.push_back({"",
                             1.0 + scale.value,
                             scale.standard_error,
                             {1.0 + priors.mean(place), factor.row(place).norm()}});
    set_day_stations(result, problem, choice, adjusted);
    if (options.calibration) {
        SurveyOptions without = options;
        without.calibration.reset();
        const AdjustedDay usual = adjusted_day(problem, choice, day_priors_of(without));
        report_prior_use(result, *options.calibration, adjusted.fit(), usual.fit(),
                         score_of(rows, choice.in_use, usual).loso_mgal);
    }
    remark_sources(result, adjusted.fit(), priors,
                   options.calibration && options.calibration->thermal, day.temperature);
    remark_faces(result, adjusted.fit());
    const double lead_s = seconds_between(day.temperature.series.start(), day.bins.front().time);
    if (lead_s < kWantedLead_s)
        result.remarks.push_back(
            text::message("the temperature record begins {} min before the first occupation; its "
                          "slow effect needs two hours",
                          std::lround(lead_s / 60.0)));
    check_fit(result, whole_day::goodness_of_fit(adjusted.survey(), adjusted.fit()));
    return result;
}

/// Alternatives of a day: each is amended, and lags and noise are searched again.
class DayTrials final : public adjustment::Trials {
public:
    DayTrials(const SurveyProblem& problem, const RowChoice& choice)
        : problem_(problem),
          choice_(choice),
          priors_(day_priors_of(problem.options)),
          covariance_(problem.day->bins),
          nearby_(problem.nearby == nullptr ? std::nullopt : std::optional(*problem.nearby)) {
        if (!problem_.temperature)
            problem_.temperature = std::make_shared<const whole_day::LaggedMeans>(*problem.day);
    }

    [[nodiscard]] std::shared_ptr<const adjustment::Residuals> residuals(
        const std::vector<adjustment::Alternative>& known,
        const std::vector<adjustment::Alternative>& quiet) override {
        if (known_fit(quiet) == nullptr) fits_.push_back({quiet, fit_of(quiet)});
        const std::optional<whole_day::DayFit>& of_quiet = known_fit(quiet)->fit;
        if (!nearby_ && of_quiet) nearby_ = of_quiet->point;
        const AmendedSurvey with = amended(problem_.rows, problem_.options, known);
        if (!of_quiet || is_refused(with)) return nullptr;
        return adjustment::effects_on(
            whole_day::set_up_residuals(survey_of(with), *of_quiet, covariance_));
    }

    void expect(const std::vector<std::vector<adjustment::Alternative>>& quiets) override {
        if (!nearby_) return;  // the first fit is the start of the others
        // The shortest of 15 days of auto needs 0.91 of the time on two cores; on busy cores nothing is
        // gained.
        std::vector<QuietFit> fits;
        for (const auto& quiet : quiets)
            if (known_fit(quiet) == nullptr) fits.push_back({quiet, {}});
        archive_series::on_all_cores(fits.size(),
                                     [&](std::size_t k) { fits[k].fit = fit_of(fits[k].quiet); });
        std::ranges::move(fits, std::back_inserter(fits_));
    }

private:
    /// A fit with some alternatives put right; absent if such a survey is refused.
    struct QuietFit {
        std::vector<adjustment::Alternative> quiet;
        std::optional<whole_day::DayFit> fit;
    };

    [[nodiscard]] const QuietFit* known_fit(
        const std::vector<adjustment::Alternative>& quiet) const {
        const auto is_same = [](const auto& a, const auto& b) { return a.is_same(b); };
        const auto found = std::ranges::find_if(fits_, [&](const QuietFit& one) {
            return std::ranges::equal(quiet, one.quiet, is_same);
        });
        return found == fits_.end() ? nullptr : &*found;
    }
    [[nodiscard]] bool is_refused(const AmendedSurvey& survey) const {
        return refusal_of({survey.rows, survey.options, problem_.day}, survey.choice).has_value();
    }
    [[nodiscard]] whole_day::DaySurvey survey_of(const AmendedSurvey& survey) const {
        return day_survey(
            {survey.rows, survey.options, problem_.day, nullptr, problem_.temperature},
            survey.choice, priors_);
    }
    [[nodiscard]] std::optional<whole_day::DayFit> fit_of(
        const std::vector<adjustment::Alternative>& quiet) const {
        const AmendedSurvey survey = amended(problem_.rows, problem_.options, quiet);
        if (is_refused(survey)) return std::nullopt;
        return whole_day::adjust_day(survey_of(survey), nearby_ ? &*nearby_ : nullptr)
            .value()
            .fit();
    }

    SurveyProblem problem_;
    RowChoice choice_;
    whole_day::DayPriors priors_;
    whole_day::NoiseCovariance covariance_;
    std::optional<whole_day::SurveyPoint> nearby_;
    std::vector<QuietFit> fits_;  ///< The size of an alternative has no effect on its fit.
};

std::unique_ptr<adjustment::Trials> day_trials(const SurveyProblem& problem,
                                               const RowChoice& choice) {
    if (refusal_of(problem, choice)) return nullptr;
    return std::make_unique<DayTrials>(problem, choice);
}

}  // namespace

std::optional<text::Message> day_refusal(const std::vector<reading::SurveyRow>& rows,
                                         const std::vector<bool>& in_use,
                                         const reading::DayRecord* day) {
    if (day == nullptr) return text::message("needs the record of the day's temperature");
    if (std::ranges::count(in_use, true) == 0)
        return text::message("needs a row with a reference, has none");
    if (day->temperature.longest_gap_s() > kLongestGap_s)
        return text::message("the temperature has a gap of {} min, more than the allowed {}",
                             std::lround(day->temperature.longest_gap_s() / 60.0),
                             std::lround(kLongestGap_s / 60.0));
    std::vector<bool> has_bins(rows.size(), false);
    for (const reading::DayBin& bin : day->bins) has_bins[bin.set_up] = true;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!has_bins[i])
            return text::message("{} ({}) has no half minute without a disturbance", rows[i].site,
                                 rows[i].occupation);
    return std::nullopt;
}

Model whole_day_model() { return {kWholeDay, false, false, fit_whole_day, score_day, day_trials}; }

}  // namespace a351::corrector::model
