#include "corrector/result/unit_history.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "protocol/text/message.hpp"

namespace a351::corrector::result {
namespace {

TermSummary summary_of(const std::vector<model::Coefficient>& terms) {
    TermSummary summary;
    summary.day_count = terms.size();
    const auto count = static_cast<double>(terms.size());
    std::vector<double> u;
    for (const model::Coefficient& term : terms) {
        summary.mean += term.value / count;
        if (term.standard_error) u.push_back(*term.standard_error);
    }
    summary.rms_u = model::root_mean_square(u);
    if (terms.size() > 1) {
        double squares = 0.0;
        for (const model::Coefficient& term : terms)
            squares += std::pow(term.value - summary.mean, 2);
        summary.scatter = std::sqrt(squares / (count - 1.0));
    }
    return summary;
}

}  // namespace

const std::vector<TermKind>& term_kinds() {
    static const std::vector<TermKind> kinds{
        {"constant_mgal", "u_constant_mgal", text::marked("Constant mGal"), 2},
        {"temperature_mgal_per_degc", "u_temperature_mgal_per_degc",
         text::marked("Static slope mGal/degC"), 1},
        {"slow_temperature_mgal_per_degc", "u_slow_temperature_mgal_per_degc",
         text::marked("Slow slope mGal/degC"), 1},
        {"rate_mgal_per_degc_per_h", "u_rate_mgal_per_degc_per_h",
         text::marked("Fast term mGal/(degC/h)"), 2},
        {"fast_lag_s", "u_fast_lag_s", text::marked("Fast lag s"), 0},
        {"slow_lag_s", "u_slow_lag_s", text::marked("Slow lag s"), 0},
        {"time_mgal_per_h", "u_time_mgal_per_h", text::marked("Drift mGal/h"), 3},
        {"scale", "u_scale", text::marked("Scale"), 5},
        {"placement_mgal", "u_placement_mgal", text::marked("Placement mGal"), 2},
        {"flicker_mgal", "u_flicker_mgal", text::marked("Flicker mGal"), 2},
        {"white_mgal", "u_white_mgal", text::marked("White noise mGal"), 2}};
    return kinds;
}

std::vector<UnitDay> unit_days(const std::vector<model::RecordedSurvey>& surveys) {
    std::vector<UnitDay> days;
    for (const model::RecordedSurvey& survey : surveys) {
        const model::SurveyCorrection& fit = *survey.result;
        const auto* const part = fit.as<model::WholeDayPart>();
        if (part == nullptr || survey.serial_number.empty()) continue;
        UnitDay& day = days.emplace_back();
        day.serial_number = survey.serial_number;
        day.name = survey.name;
        day.loso_mgal = fit.score.loso_mgal;
        day.uncertainty_factor = part->uncertainty_factor;
        day.start = UtcTime::max();
        for (const model::CorrectedRow& row : fit.rows)
            day.start = std::min(day.start, row.row.first_instant());
        for (const TermKind& kind : term_kinds()) {
            const auto found =
                std::ranges::find(fit.coefficients, kind.name, &model::Coefficient::name);
            day.terms.push_back(found == fit.coefficients.end() ? std::nullopt
                                                                : std::optional(*found));
        }
    }
    std::ranges::sort(days, {}, [](const UnitDay& day) {
        return std::tie(day.serial_number, day.start, day.name);
    });
    return days;
}

const std::vector<Column<UnitDay>>& unit_day_columns() {
    static const std::vector<Column<UnitDay>> columns = [] {
        std::vector<Column<UnitDay>> all{
            {"serial_number", of(&UnitDay::serial_number), {text::marked("Unit"), 0, 'n'}},
            {"start_utc", of(&UnitDay::start), {text::marked("First reading UTC"), 0, 'n'}},
            {"name", of(&UnitDay::name), {text::marked("Day"), 0, 'n'}},
            {"loso_mgal", of(&UnitDay::loso_mgal), {text::marked("Left out mGal"), 2}},
            {"uncertainty_factor", of(&UnitDay::uncertainty_factor), {}}};
        for (std::size_t k = 0; k < term_kinds().size(); ++k) {
            const TermKind& kind = term_kinds()[k];
            const auto of_term = [k](auto member) {
                return [k, member](const UnitDay& day) {
                    return day.terms[k] ? cell((*day.terms[k]).*member) : Cell();
                };
            };
            all.push_back(
                {kind.name, of_term(&model::Coefficient::value), {kind.heading, kind.decimals}});
            all.push_back({kind.u_key, of_term(&model::Coefficient::standard_error)});
        }
        return all;
    }();
    return columns;
}

std::vector<TermSummary> summarise(const std::vector<UnitDay>& days) {
    std::vector<TermSummary> summaries;
    for (auto first = days.begin(); first != days.end();) {
        const auto end = std::find_if(first, days.end(), [&](const UnitDay& day) {
            return day.serial_number != first->serial_number;
        });
        for (std::size_t k = 0; k < term_kinds().size(); ++k) {
            std::vector<model::Coefficient> terms;
            for (auto day = first; day != end; ++day)
                if (day->terms[k]) terms.push_back(*day->terms[k]);
            if (terms.empty()) continue;
            TermSummary& summary = summaries.emplace_back(summary_of(terms));
            summary.serial_number = first->serial_number;
            summary.term = term_kinds()[k].name;
        }
        first = end;
    }
    return summaries;
}

const std::vector<Column<TermSummary>>& term_summary_columns() {
    static const std::vector<Column<TermSummary>> columns{
        {"serial_number", of(&TermSummary::serial_number), {text::marked("Unit"), 0, 'n'}},
        {"term", of(&TermSummary::term), {text::marked("Term"), 0, 'n'}},
        {"days", of(&TermSummary::day_count), {text::marked("Days")}},
        {"mean", of(&TermSummary::mean), {text::marked("Mean"), 4}},
        {"scatter", of(&TermSummary::scatter), {text::marked("Scatter of a day"), 4}},
        {"rms_u", of(&TermSummary::rms_u), {text::marked("u of a day"), 4}}};
    return columns;
}

}  // namespace a351::corrector::result
