#include "corrector/report/joint_page.hpp"

#include <pugixml.hpp>

#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::report;

namespace {

/// Returns the made-up day without the reference of a station, whose value is off by `off_mgal`.
SurveyCorrection day_with(const std::string& site, double off_mgal) {
    auto rows = made_up::day();
    for (SurveyRow& row : rows)
        if (row.site == site) row.reference.reset();
    SurveyCorrection day = correct_survey(rows, {.model = "t-rate-drift"});
    for (StationValue& station : day.stations) {
        if (station.site == site) station.gravity = station.gravity + MilliGal(off_mgal);
        station.left_out = station.gravity;
        station.u_left_out = MilliGal(1.5);
    }
    return day;
}

std::optional<DayScatter> scatter_of(const std::vector<SurveyCorrection>& days) {
    std::vector<RecordedSurvey> surveys;
    for (const SurveyCorrection& day : days) surveys.push_back({"", "", &day});
    return scatter_of_days(surveys);
}

/// Returns the page of days that are not adjusted together.
std::string page_of(const std::vector<JointDay>& days, const std::string& reason) {
    const Report report = make_joint_page(days, reason, {}, {});
    CHECK(report.files.size() == 1);
    return report.files.front().second;
}

}  // namespace

TEST_CASE("the scatter from day to day is given with the value expected from u") {
    const auto scatter = scatter_of({day_with("S4", 0.0), day_with("S4", 4.0)}).value();
    CHECK(scatter.dof == 8);                                  // eight stations, twice
    CHECK(scatter.rms_mgal == Approx(std::sqrt(8.0 / 8.0)));  // -2 and 2 at one of them
    CHECK(scatter.expected_mgal.value() == Approx(1.5));
    CHECK_FALSE(scatter_of({day_with("S4", 0.0)}).has_value());
}

TEST_CASE("the expected scatter leaves out what the days share, with its sign") {
    std::vector<SurveyCorrection> days{day_with("S4", 0.0), day_with("S4", 0.0)};
    const auto expected = [&days](double shared_a, double shared_b) {
        for (std::size_t k = 0; k < 2; ++k)
            for (StationValue& station : days[k].stations) {
                station.shared = SharedErrors{};
                station.shared->unit_mgal = {0.0, 0.0, k == 0 ? shared_a : shared_b};
            }
        return scatter_of(days).value().expected_mgal.value();
    };
    CHECK(expected(0.9, 0.9) == Approx(std::sqrt(1.5 * 1.5 - 0.81)));
    CHECK(expected(0.9, -0.9) == Approx(std::sqrt(1.5 * 1.5 + 0.81)));
}

TEST_CASE("the joint page lists every day, the differences, and the reason for a missing day") {
    const SurveyCorrection first = day_with("S4", 0.0);
    const SurveyCorrection second = day_with("S4", 4.0);
    const std::string html = page_of({{"mon <1>/a", "mon <1>-a", &first},
                                      {"tue", "tue", nullptr, "day.toml: no <occupation>"},
                                      {"wed", "wed", &second}},
                                     "they have no records");
    pugi::xml_document document;
    REQUIRE(document.load_string(html.c_str()));
    CHECK(document.select_nodes("//p/a").size() == 2);
    CHECK(document.select_node("//p/a").node().attribute("href").value() ==
          std::string("mon%20%3C1%3E-a/report.html"));
    CHECK_THAT(html, ContainsSubstring("<li>tue: day.toml: no &lt;occupation&gt;</li>") &&
                         ContainsSubstring("<td class=\"n\">not corrected</td>") &&
                         ContainsSubstring("no joint adjustment, because they have no records.") &&
                         ContainsSubstring("differ by 1.00 mGal rms from day to day (8 degrees"));
    bool is_found = false;
    for (const auto& row : document.select_nodes("//tr")) {
        const auto cells = row.node().children("td");
        if (std::string(row.node().child_value("td")) != "S4" ||
            row.node().child("td").next_sibling().text().as_int() != 2)
            continue;
        std::vector<std::string> texts;
        for (const auto& cell : cells) texts.emplace_back(cell.child_value());
        REQUIRE(texts.size() == 7);  // Without a joint value, u and residual.
        CHECK(texts[1] == "2");
        const auto of_first = std::stod(texts[5]), of_second = std::stod(texts[6]);
        CHECK(of_second - of_first == Approx(4.0).margin(0.11));
        CHECK_THAT(texts[5], EndsWith(" +- 1.5"));
        is_found = true;
    }
    CHECK(is_found);
}

TEST_CASE("the joint page says which stations to trust and to repeat over the days") {
    SurveyCorrection first = day_with("S4", 0.0);
    SurveyCorrection second = day_with("S4", 7.0);  // 7 / (1.5 sqrt(2)) = 3.3
    const auto to_repeat = [](SurveyCorrection& day, const std::string& site) {
        for (CorrectedRow& row : day.rows)
            if (row.row.site == site) row.row.notes = {"excluded"};
    };
    to_repeat(first, "S1");
    to_repeat(first, "S5");
    to_repeat(second, "S5");
    Finding finding;
    finding.text = "The box was moved.";
    finding.is_headline = true;
    first.findings = {finding};
    const std::string html =
        page_of({{"mon", "mon", &first}, {"tue", "tue", &second}}, "of a test");
    CHECK_THAT(
        html,
        ContainsSubstring("<li>mon: The box was moved.</li>") &&
            ContainsSubstring("days disagree: S4, S5.</li>") &&
            ContainsSubstring("<li>Trust: B, S1, S2, S3, S6, S7.</li>") &&
            ContainsSubstring("mon and tue differ by 7.0 mGal, 3.3 times the uncertainty") &&
            ContainsSubstring("mon, S5 (1): excluded by an amendment; tue, S5 (1): excluded"));
}
