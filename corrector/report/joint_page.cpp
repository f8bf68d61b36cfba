#include "corrector/report/joint_page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "corrector/figure/history_figure.hpp"
#include "corrector/judgement/reading_grade.hpp"
#include "corrector/report/html.hpp"
#include "corrector/result/joint_table.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::report {
namespace {

/// Returns a name as a part of a relative address (RFC 3986; unreserved characters are not
/// changed).
std::string address_part(const std::string& name) {
    constexpr std::string_view kUnreserved =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
    std::string text;
    for (const char c : name) {
        if (kUnreserved.find(c) != std::string_view::npos) {
            text += c;
        } else {
            text += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return text;
}

void add_days(pugi::xml_node parent, const std::vector<JointDay>& days) {
    std::vector<HtmlCells> rows;
    for (const JointDay& day : days) {
        HtmlCells& cells = rows.emplace_back(7, "-");
        cells[0] = day.name;
        if (day.result == nullptr) {
            cells[1] = text::tr("not corrected");
            continue;
        }
        const model::SurveyCorrection& result = *day.result;
        cells[1] = to_rfc3339(result.rows.front().row.time);
        cells[2] = to_rfc3339(result.rows.back().row.time);
        cells[3] = result.model;
        cells[4] = text::tr("{} of {}", result.score.row_count, result.rows.size());
        cells[5] = text::fixed_or(result.score.rms_mgal, 2, "-");
        cells[6] = text::fixed_or(result.score.loso_mgal, 2, "-");
    }
    add_table(
        parent,
        text::tr("The days. The RMS of the residuals is in sample, that of stations left out is "
                 "cross-validated."),
        "nnnnrrr",
        {text::tr("Survey"), text::tr("First reading UTC"), text::tr("Last reading UTC"),
         text::tr("Model"), text::tr("In the fit"), text::tr("RMS mGal (in sample)"),
         text::tr("RMS mGal (cross-validated, leave-one-station-out)")},
        rows);
}

void add_links(pugi::xml_node parent, const std::vector<JointDay>& days) {
    pugi::xml_node line;
    for (const JointDay& day : days) {
        if (day.result == nullptr) continue;
        if (line) {
            add_text(line, ", ");
        } else {
            line = add(parent, "p", text::tr("Reports: "));
        }
        add(line, "a", day.name).append_attribute("href") =
            (address_part(day.folder) + "/report.html").c_str();
    }
    if (line) add_text(line, ".");
}

void add_joint_stations(pugi::xml_node parent, const std::vector<model::RecordedSurvey>& surveys,
                        const std::vector<result::JointStation>& stations, bool is_adjusted) {
    const std::string caption =
        is_adjusted
            ? text::tr(
                  "Gravity from the adjustment of all surveys, with its standard uncertainty u. It "
                  "does not use the station's own reference (left out). In sample: this is the "
                  "only reference, so the value uses it. Differences of stations are in "
                  "joint-differences.csv. NAME - joint: the day's own value minus that of the "
                  "adjustment. *: only readings that were left out of the day's fit.")
            : text::tr(
                  "Gravity of each survey with its standard uncertainty u. It does not use the "
                  "station's own reference (left out). In sample: one of the surveys has only a "
                  "value that uses it. *: only readings that were left out of the survey's fit.");
    add_table(parent, caption, result::table_by_survey(stations, surveys, is_adjusted));
}

/// A grade of a station over all days, with its reasons.
struct Advice {
    judgement::Grade grade = judgement::Grade::repeat;
    std::vector<std::string> reasons;
};

/// Adds a reason if two days disagree about a station by more than their uncertainties explain.
void compare_days(Advice& advice, const model::RecordedSurvey& a, const model::RecordedSurvey& b,
                  const std::string& site) {
    const model::StationValue* const of_a = a.result->station(site);
    const model::StationValue* const of_b = b.result->station(site);
    if (of_a == nullptr || of_b == nullptr) return;
    const result::DayValue value_a = result::day_value(*of_a), value_b = result::day_value(*of_b);
    if (!value_a.u || !value_b.u) return;
    const double variance_mgal2 = std::pow(value_a.u->value(), 2) +
                                  std::pow(value_b.u->value(), 2) -
                                  2.0 * result::covariance_mgal2(*of_a, *of_b);
    if (!(variance_mgal2 > 0.0)) return;
    const double difference_mgal = std::abs((value_a.gravity - value_b.gravity).value());
    const double ratio = difference_mgal / std::sqrt(variance_mgal2);
    if (ratio <= judgement::kCareRatio) return;
    advice.grade = std::max(advice.grade, ratio > judgement::kRepeatRatio ? judgement::Grade::repeat
                                                                          : judgement::Grade::care);
    advice.reasons.push_back(
        text::tr("{} and {} differ by {} mGal, {} times the uncertainty of the difference", a.name,
                 b.name, text::fixed(difference_mgal, 1), text::fixed(ratio, 1)));
}

/// Returns the best grade of a station on a day, or a worse one if the days disagree.
Advice advice_on(const std::string& site, const std::vector<model::RecordedSurvey>& days) {
    Advice advice;
    std::vector<std::string> reasons;
    for (const model::RecordedSurvey& day : days) {
        if (day.result->station(site) == nullptr) continue;
        const judgement::ReadingGrade of_day =
            judgement::grade_of_station(*day.result, judgement::grade_readings(*day.result), site);
        advice.grade = std::min(advice.grade, of_day.grade);
        if (!of_day.reasons.empty())
            reasons.push_back(
                text::tr("{}, {}", day.name, text::Message(judgement::reason_in_words(of_day))));
    }
    if (advice.grade != judgement::Grade::trust) advice.reasons = reasons;
    for (auto a = days.begin(); a != days.end(); ++a)
        for (auto b = a + 1; b != days.end(); ++b) compare_days(advice, *a, *b, site);
    return advice;
}

/// Adds the mistakes found with certainty, and the stations to trust and to repeat.
void add_joint_actions(pugi::xml_node parent, const std::vector<model::RecordedSurvey>& days,
                       const std::vector<result::JointStation>& stations) {
    std::vector<std::string> items;
    for (const model::RecordedSurvey& day : days)
        for (const reading::Finding& finding : day.result->findings)
            if (finding.is_headline)
                items.push_back(fmt::format("{}: {}", day.name, text::in_words(finding.text)));
    std::array<std::vector<std::string>, 3> sites;  // by grade
    std::array<std::vector<HtmlCells>, 3> reasons;
    for (const result::JointStation& station : stations) {
        const Advice advice = advice_on(station.site, days);
        const auto grade = static_cast<std::size_t>(advice.grade);
        sites.at(grade).push_back(station.site);
        if (!advice.reasons.empty())
            reasons.at(grade).push_back({station.site,
                                         text::translated(judgement::grade_name(advice.grade)),
                                         text::joined(advice.reasons, "; ")});
    }
    const auto add_group = [&](judgement::Grade grade, const std::string& what) {
        const auto& group = sites.at(static_cast<std::size_t>(grade));
        if (!group.empty()) items.push_back(text::tr("{}: {}.", what, text::joined(group)));
    };
    add_group(judgement::Grade::repeat,
              text::tr("Repeat, no day has a value to trust or the days disagree"));
    if (items.empty()) items.push_back(text::tr("No station needs to be repeated."));
    add_group(judgement::Grade::care, text::tr("Use with care"));
    add_group(judgement::Grade::trust, text::tr("Trust"));
    add_list(parent, items);
    std::vector<HtmlCells> rows;
    for (const auto& group : {reasons[2], reasons[1]})
        rows.insert(rows.end(), group.begin(), group.end());
    if (!rows.empty())
        add_table(
            parent,
            text::tr(
                "Stations with remarks. Differences between days are of values that do not use the "
                "station's own reference (left out), with their standard uncertainty u."),
            "nnl", {text::tr("Station"), text::tr("Grade"), text::tr("Why")}, rows);
}

std::string scatter_sentence(const std::vector<model::RecordedSurvey>& days) {
    const auto scatter = scatter_of_days(days);
    if (!scatter)
        return text::tr("No station was measured on two days, so the days cannot be compared.");
    const std::string expected = text::fixed_or(scatter->expected_mgal, 2, "");
    return text::tr(
        "Stations measured on several days differ by {} mGal rms from day to day ({} degrees of "
        "freedom){}.",
        text::fixed(scatter->rms_mgal, 2), scatter->dof,
        expected.empty()
            ? ""
            : text::tr("; expected from the part of u that the days do not share: {}", expected));
}

}  // namespace

std::optional<DayScatter> scatter_of_days(const std::vector<model::RecordedSurvey>& days) {
    DayScatter scatter;
    double squares = 0.0, expected = 0.0;
    bool has_all_u = true;
    for (const result::JointStation& station : result::joint_tables(days, nullptr).stations) {
        if (station.day_count < 2) continue;
        std::vector<const model::StationValue*> values;
        for (const model::RecordedSurvey& day : days)
            if (const auto* const value = day.result->station(station.site))
                values.push_back(value);
        const auto n = static_cast<double>(values.size());
        double mean = 0.0;  // of the differences from the first day
        const MilliGal first = result::day_value(*values.front()).gravity;
        const auto off = [first](const model::StationValue& value) {
            return (result::day_value(value).gravity - first).value();
        };
        for (const auto* const value : values) mean += off(*value) / n;
        for (const auto* const a : values) {
            squares += std::pow(off(*a) - mean, 2);
            const auto u = result::day_value(*a).u;
            has_all_u = has_all_u && u;
            if (u) expected += std::pow(u->value(), 2) * (1.0 - 1.0 / n);
            for (const auto* const b : values)
                if (a != b) expected -= result::covariance_mgal2(*a, *b) / n;
        }
        scatter.dof += values.size() - 1;
    }
    if (scatter.dof == 0) return std::nullopt;
    scatter.rms_mgal = std::sqrt(squares / static_cast<double>(scatter.dof));
    if (has_all_u) scatter.expected_mgal = std::sqrt(expected / static_cast<double>(scatter.dof));
    return scatter;
}

Report make_joint_page(const std::vector<JointDay>& days, const result::JointResult& joint,
                       const std::vector<result::UnitDay>& units,
                       const figure::FigureOptions& options) {
    std::vector<model::RecordedSurvey> corrected;
    std::vector<std::string> troubles;
    for (const JointDay& day : days) {
        if (day.result != nullptr)
            corrected.push_back({day.name, "", day.result, nullptr});
        else
            troubles.push_back(fmt::format("{}: {}", day.name, day.trouble));
    }
    std::vector<figure::Figure> figures;
    if (!units.empty()) figures.push_back(figure::history_figure(units, options.print));
    figure::Drawing drawing = figure::draw(figures, options.formats);
    Report report;
    report.warnings = missing_lines(drawing.troubles);
    Page page(text::tr("Gravity of {} surveys", days.size()));
    add_list(page.body(), report.warnings);
    if (!troubles.empty())
        add(page.body(), "p", text::tr("Not corrected, and not included below:"));
    add_list(page.body(), troubles);
    const auto* const adjustment = std::get_if<model::JointAdjustment>(&joint);
    const auto joined = result::joint_tables(corrected, adjustment).stations;
    add_joint_actions(page.add_section(text::tr("What to do")), corrected, joined);
    const pugi::xml_node stations = page.add_section(text::tr("Stations"));
    for (const std::string& sentence : result::joint_sentences(joint)) add(stations, "p", sentence);
    add_joint_stations(stations, corrected, joined, adjustment != nullptr);
    add(stations, "p", scatter_sentence(corrected));
    if (!units.empty()) {
        const pugi::xml_node section = page.add_section(text::tr("The units"));
        add_table(section,
                  text::tr("Terms of each unit over its days, each fitted alone: a term that does "
                           "not change scatters by about its u, or less."),
                  result::table_of(result::term_summary_columns(), result::summarise(units)));
        add_figures(section, figures, drawing);
    }
    const pugi::xml_node section = page.add_section(text::tr("The surveys"));
    add_days(section, days);
    add_links(section, days);
    report.files.emplace_back("joint.html", page.text());
    add_figure_files(report.files, figures, drawing);
    return report;
}

}  // namespace a351::corrector::report
