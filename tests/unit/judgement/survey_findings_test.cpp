#include "corrector/judgement/survey_findings.hpp"

#include <nlohmann/json.hpp>
#include <set>

#include "corrector/judgement/mistake_sentences.hpp"
#include "corrector/judgement/still_box.hpp"
#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector;
using reading::Finding;
using reading::FindingKind;

namespace {

/// A made-up day with a scatter of 0.3 mGal, and the list of its sites with one more.
struct Day {
    std::vector<reading::SurveyRow> rows = model::made_up::day_with_errors(
        {0.3, -0.2, 0.1, -0.4, 0.2, 0.4, -0.3, 0.1, -0.1, 0.3, -0.3, 0.0});
    std::vector<text::Site> sites;

    Day() {
        for (reading::SurveyRow& row : rows) {
            row.listed = {row.site, row.occupation, std::nullopt};
            if (text::find_site(sites, row.site) == nullptr)
                sites.push_back(
                    {row.site, Degrees(140.0), Degrees(36.0), Metres(0.0), row.reference});
        }
        sites.push_back({"S9", Degrees(140.0), Degrees(36.0), Metres(0.0), MilliGal(979900.0)});
        // The references are not those of a place, so they are not compared with normal gravity.
        for (text::Site& site : sites) site.has_altitude = false;
    }

    [[nodiscard]] std::vector<Finding> findings(const std::string& model = "t-rate-drift") const {
        return judgement::find_mistakes(model::correct_survey(rows, {.model = model}),
                                        {rows, sites, nullptr});
    }

    void off(std::size_t i, double mgal) { model::add(rows[i], mgal); }
};

std::vector<std::string> kinds(const std::vector<Finding>& findings) {
    std::vector<std::string> list;
    for (const Finding& finding : findings) list.emplace_back(to_text(finding.kind));
    return list;
}

using Kinds = std::vector<std::string>;

}  // namespace

TEST_CASE("of a good day only the benchmarks that were not visited are said") {
    for (const std::string model : {"t-rate-drift", "network", "paper"}) {
        const auto findings = Day().findings(model);
        REQUIRE(kinds(findings) == Kinds{"not_visited"});
        CHECK(findings.back().text == "without a reading in this day: S9");
        CHECK_FALSE(findings.back().is_headline);
    }
}

TEST_CASE("a wrong reference is named with its size and an amendment") {
    Day day;
    for (auto& row : day.rows)
        if (row.site == "S2") row.reference = *row.reference + MilliGal(50.0);
    for (const std::string model : {"t-rate-drift", "network"}) {
        const auto findings = day.findings(model);
        REQUIRE(kinds(findings) == Kinds{"unusable_day", "reference", "not_visited"});
        CHECK(findings[1].site == "S2");
        CHECK(std::abs(*findings[1].size_mgal - 50.0) < 3.0);
        CHECK(findings[1].text.english().find("mGal too high") != std::string::npos);
        CHECK(findings[1].amendment.find("[[reference]]\nsite = \"S2\"\nuse = false\n") == 0);
        CHECK(findings[1].is_headline);
    }
}

TEST_CASE("of two references that contradict each other neither is named as the wrong one") {
    for (const std::string wrong : {"B", "S2"}) {
        Day day;
        for (std::size_t i = 0; i < day.rows.size(); ++i) {
            reading::SurveyRow& row = day.rows[i];
            const reading::SurveyRow other = Day().rows[i % 2 == 0 ? 0 : 2];
            day.off(i, (*other.reference - *row.reference).value());
            row.site = row.listed.site = other.site;
            row.occupation = static_cast<int>(i / 2 + 1);
            row.reference = *other.reference + MilliGal(row.site == wrong ? 50.0 : 0.0);
        }
        const auto findings = day.findings("network");
        const auto found = std::ranges::find(findings, "references_contradict", &Finding::code);
        for (const Finding& one : findings) UNSCOPED_INFO(one.text.english());
        REQUIRE(found != findings.end());
        CHECK(std::set{found->site, found->other_site} == std::set<std::string>{"B", "S2"});
        CHECK(found->text.english().find("contradict each other by ") != std::string::npos);
        CHECK(found->amendment.empty());
    }
}

TEST_CASE("stays at several benchmarks of a box that did not move make a day unusable") {
    Day day;
    const auto is_still = [&day] { return day.findings().front().code == "still_box"; };
    const auto level = [&day](std::size_t i, double g) {
        day.rows[i].record->x.mean = StandardGravity(g);
    };
    for (std::size_t i = 0; i < day.rows.size(); ++i) {
        day.rows[i].acceleration = day.rows[0].acceleration;
        day.rows[i].record.emplace();
        level(i, 1e-4 * static_cast<double>(i));  // 0.0057 deg from its neighbours
    }
    CHECK_FALSE(is_still());
    for (std::size_t i = 0; i < day.rows.size(); ++i) level(i, 0.0);
    CHECK(day.findings().front().text ==
          "the box did not move from B (1) to B (3), 12 stays one after the other at different "
          "benchmarks: check date, hour and zone of the stays");
    CHECK(day.findings().front().is_headline);
    for (std::size_t i = 0; i < day.rows.size(); i += 3) day.off(i, i % 2 == 0 ? 1000.0 : 2000.0);
    CHECK_FALSE(is_still());  // Two in a row are not enough.
    for (std::size_t i = 0; i < day.rows.size(); ++i)
        day.rows[i].acceleration = day.rows[i - i % 4].acceleration;
    day.off(4, 1000.0);
    CHECK(is_still());
    for (auto& row : day.rows) row.record.reset();  // A table of averages says nothing of a box.
    CHECK_FALSE(is_still());
}

TEST_CASE("a set-up of a box that was not lifted is named, with its exclusion") {
    std::vector<reading::SurveyRow> rows(3);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].site = "A";
        rows[i].time = UtcTime(std::chrono::minutes(10 * i));
        rows[i].listed = {"A", 1, static_cast<int>(i) + 1};
        rows[i].record.emplace().x.mean = StandardGravity(i == 2 ? 6e-6 : 0.0);  // 0.00034 deg
    }
    const auto found = judgement::set_ups_not_lifted(rows);
    REQUIRE(found.size() == 1);
    CHECK(
        found[0].text ==
        "A (1): the box was not lifted before the set-up at 1970-01-01T00:10:00Z, so its placement "
        "was not averaged and u is too small");
    CHECK(found[0].amendment ==
          "[[exclude]]\nsite = \"A\"\noccupation = 1\nset_up = 2\nreason = \"box not lifted\"\n");
    rows[0].is_excluded = true;
    CHECK(judgement::set_ups_not_lifted(rows).empty());
    rows[0].is_excluded = false;
    rows[1].occupation = 2;
    CHECK(judgement::set_ups_not_lifted(rows).empty());  // It came back.
}

TEST_CASE("a reading under another site's name is named with that site") {
    Day day;
    const text::Site& other = day.sites.back();
    // S5 was read, but it is called S9
    day.rows[6].site = day.rows[6].listed.site = other.name;
    day.rows[6].reference = other.gravity;
    const auto findings = day.findings();
    REQUIRE(kinds(findings) == Kinds{"unusable_day", "other_name", "not_visited"});
    CHECK(findings[1].site == "S9");
    CHECK(findings[1].other_site == "S5");
    CHECK(findings[1].code == "other_name_or_reference");
    CHECK(findings[1].amendment ==
          "[[rename]]\nsite = \"S9\"\noccupation = 1\nto = \"S5\"\nreason = \"reads like S5\"\n");
}

TEST_CASE("swapped names are two findings, a step has its time") {
    Day swapped;
    std::swap(swapped.rows[1].site, swapped.rows[8].site);
    std::swap(swapped.rows[1].reference, swapped.rows[8].reference);
    const auto names = swapped.findings();
    REQUIRE(names.size() >= 2);
    const auto is_name = [](const Finding& finding) {
        return finding.kind == FindingKind::other_name;
    };
    CHECK(std::ranges::count_if(names, is_name) == 2);
    // One proposal renames both: half of it would make two stays of one site.
    const auto first = std::ranges::find_if(names, is_name);
    CHECK(std::next(first)->amendment.empty());
    CHECK(first->amendment.find("to = \"" + first->other_site + "\"") != std::string::npos);
    CHECK(first->amendment.find("to = \"" + std::next(first)->other_site + "\"") !=
          std::string::npos);

    Day stepped;
    for (std::size_t i = 6; i < stepped.rows.size(); ++i) stepped.off(i, -30.0);
    for (const std::string model : {"t-rate-drift", "network"}) {
        const auto found = stepped.findings(model);
        const auto step = std::ranges::find(found, FindingKind::step, &Finding::kind);
        REQUIRE(step != found.end());
        CHECK(std::abs(*step->size_mgal + 30.0) < 3.0);
        CHECK(*step->time > stepped.rows[5].time);
        CHECK(*step->time < stepped.rows[6].time);
        CHECK(step->text.english().find("too low") != std::string::npos);
        CHECK(step->amendment.find("[[step]]\ntime_utc = ") == 0);
    }
}

TEST_CASE("a step that one stay alone shows may be a wrong name of this stay") {
    using adjustment::AlternativeKind;
    // A and B are known; the last stay, called B, was at A.
    std::vector<reading::SurveyRow> rows;
    std::vector<judgement::SearchedReading> readings;
    for (const std::string site : {"A", "B", "C", "D", "E", "B"}) {
        reading::SurveyRow& row = rows.emplace_back();
        row.site = site;
        row.occupation =
            static_cast<int>(std::ranges::count(rows, site, &reading::SurveyRow::site));
        row.time = UtcTime(std::chrono::hours(rows.size()));
        row.listed = {site, row.occupation, std::nullopt};
        if (site == "A") row.reference = MilliGal(979860.0);
        if (site == "B") row.reference = MilliGal(979770.0);
        readings.emplace_back().site = site;
        readings.back().occupation = row.occupation;
    }
    std::vector<text::Site> sites{{"A", {}, {}, {}, MilliGal(979860.0)}};
    const auto finding_of = [&](std::size_t from, double size_mgal) {
        judgement::Mistake step;
        step.kind = AlternativeKind::step;
        for (std::size_t i = from; i < rows.size(); ++i) step.readings.push_back(i);
        step.size_mgal = size_mgal;
        step.u_mgal = 2.0;
        return judgement::findings_of(step, readings, rows, model::choose_rows(rows, {}, true),
                                      sites)
            .front();
    };
    const Finding name = finding_of(2, 89.0);
    CHECK(
        name.text ==
        "B (2) is 89.0 +- 2.0 mGal too high; it reads like A (1.0 mGal); or the instrument stepped "
        "between B (1) and B (2); another known benchmark shows which");
    CHECK(name.kind == FindingKind::other_name);
    CHECK(name.amendment.starts_with("[[rename]]\nsite = \"B\"\noccupation = 2\nto = \"A\"\n"));
    const Finding bad = finding_of(4, 60.0);
    CHECK(bad.text ==
          "B (2) is 60.0 +- 2.0 mGal too high: its name or its reference is wrong, or the stay is "
          "bad; or the instrument stepped between B (1) and B (2); another known benchmark shows "
          "which");
    CHECK(bad.amendment.starts_with("[[exclude]]\nsite = \"B\"\noccupation = 2\n"));
    const Finding early = finding_of(1, 90.0);  // Only A is before it.
    CHECK(early.text.english().starts_with("A (1) is 90.0 +- 2.0 mGal too low: "));
    CHECK(early.text.english().find("the instrument stepped between A (1) and B (1)") !=
          std::string::npos);
    // With a large u any site is within reach.
    CHECK(finding_of(2, 19.0).amendment.starts_with("[[exclude]]"));
    // A second station that is read before it, in this loop or in another one, shows the step too.
    rows.insert(rows.begin(), reading::SurveyRow(rows[4]));
    readings.insert(readings.begin(), judgement::SearchedReading(readings[4]));
    CHECK(finding_of(3, 89.0).kind == FindingKind::step);
    readings[0].loop = 1;
    CHECK(finding_of(3, 89.0).kind == FindingKind::step);
    rows[0].site = readings[0].site = "F";
    CHECK(finding_of(3, 89.0).kind == FindingKind::other_name);
}

TEST_CASE("a bad reading of a station with others is to be repeated") {
    Day day;
    day.off(9, 25.0);  // the second stay at S2
    const auto findings = day.findings();
    const auto bad = std::ranges::find(findings, FindingKind::bad_reading, &Finding::kind);
    REQUIRE(bad != findings.end());
    CHECK(bad->site == "S2");
    CHECK(bad->occupation == 2);
    CHECK(bad->amendment.find("[[exclude]]\nsite = \"S2\"\noccupation = 2\n") == 0);
    day.rows[9].is_excluded = true;
    CHECK(kinds(day.findings()) == Kinds{"not_visited"});
}

TEST_CASE("two bad readings of one day are both named") {
    Day day;
    day.off(2, 60.0);
    day.off(8, -40.0);
    std::set<std::string> sites;
    for (const Finding& finding : day.findings())
        if (finding.size_mgal) sites.insert(finding.site);
    CHECK(sites == std::set<std::string>{"S2", "S7"});
}

TEST_CASE("nothing is said of benchmarks that another sensor of the day may have visited") {
    const Day day;
    model::SurveyCorrection result = model::correct_survey(day.rows, {.model = "t-rate-drift"});
    result.findings.push_back({.kind = FindingKind::other_unit, .code = "other_unit"});
    CHECK(kinds(judgement::find_mistakes(result, {day.rows, day.sites, nullptr})) ==
          Kinds{"other_unit"});
}

TEST_CASE("a day that no mistake explains is not usable either") {
    Day day;
    const std::vector<reading::SurveyRow> right = day.rows;
    for (std::size_t i = 0; i < right.size(); ++i) {  // each has the name of the next one
        const reading::SurveyRow& next = right[(i + 1) % right.size()];
        day.rows[i].site = next.site;
        day.rows[i].occupation = next.occupation;
        day.rows[i].listed = next.listed;
        day.rows[i].reference = next.reference;
    }
    const auto findings = day.findings();
    REQUIRE(!findings.empty());
    CHECK(findings[0].kind == FindingKind::unusable_day);
    CHECK(findings[0].is_headline);
    CHECK(findings[0].amendment.empty());
    CHECK_THAT(findings[0].text.english(),
               ContainsSubstring("check times, names, signs and units"));

    // References that are as uncertain as that explain it, and four stations are too few.
    for (reading::SurveyRow& row : day.rows) row.u_reference = MilliGal(500.0);
    CHECK(std::ranges::count(kinds(day.findings()), "unusable_day") == 0);
    for (reading::SurveyRow& row : day.rows) {
        row.u_reference.reset();
        if (row.site != "B" && row.site != "S1" && row.site != "S2" && row.site != "S3")
            row.reference.reset();
    }
    CHECK(std::ranges::count(kinds(day.findings("t")), "unusable_day") == 0);
}

TEST_CASE("a site that does not fit the others is a remark") {
    Day day;
    day.sites[2].longitude = Degrees(-140.0);
    const auto found = day.findings();
    REQUIRE(kinds(found) == Kinds{"doubtful_site", "not_visited"});
    CHECK_THAT(found[0].text.english(), StartsWith(day.sites[2].name + " is "));
    CHECK_FALSE(found[0].is_headline);
}

TEST_CASE("a base with one stay is named") {
    Day day;
    for (const std::size_t i : {std::size_t{4}, std::size_t{11}}) {
        day.rows[i].site = "S1";
        day.rows[i].occupation = static_cast<int>(i);
        day.off(i, (*day.rows[1].reference - *day.rows[i].reference).value());
        day.rows[i].reference = day.rows[1].reference;
    }
    const auto found = day.findings();
    REQUIRE(kinds(found) == Kinds{"base_not_revisited", "not_visited"});
    CHECK(found[0].text ==
          "the base B was read only once; a second stay would show a drift without any reference");
}

TEST_CASE("a day that the model does not fit is named, with the reading after the step") {
    using whole_day::Misfit;
    const Day day;
    model::SurveyOptions options;
    options.model = "paper";  // a model that is not searched
    model::SurveyCorrection result = model::correct_survey(day.rows, options);
    const auto said = [&](const whole_day::FitTest& test) {
        model::WholeDayPart part;
        part.fit_tests = {test};
        result.own = part;
        const auto findings = judgement::find_mistakes(result, {day.rows, day.sites, nullptr});
        REQUIRE_FALSE(findings.empty());
        return findings.front();
    };
    const Finding step = said({Misfit::step, 0.014, 4});
    CHECK(step.code == "misfit_step");
    CHECK(step.site == day.rows[4].site);
    CHECK_FALSE(step.is_headline);
    CHECK(said({Misfit::curvature, 0.007, 1}).text.english() ==
          "the model does not fit this day: the residuals follow the square of the time (p = "
          "0.0070)");
    CHECK(said({Misfit::tails, 0.001, 4}).text.english() ==
          "the model does not fit this day: a few set-ups are much further off than the others, B "
          "(2) most (p = 0.0010)");
    CHECK(said({Misfit::step, 0.016, 4}).kind != FindingKind::misfit);
    CHECK(said({Misfit::tails, 0.009, 4}).kind != FindingKind::misfit);
}

TEST_CASE("a table has findings, but no amendments") {
    Day day;
    for (auto& row : day.rows) row.listed = {};
    day.off(9, 25.0);
    for (const Finding& finding : day.findings()) CHECK(finding.amendment.empty());
}

TEST_CASE("findings have all keys, and null for what does not apply") {
    const auto json = reading::findings_json(
        {{.kind = FindingKind::not_visited, .code = "not_visited", .text = "x"}});
    CHECK(
        json.dump() ==
        R"([{"kind":"not_visited","code":"not_visited","is_headline":false,"site":null,"occupation":null,)"
        R"("key":null,"time_utc":null,"size_mgal":null,"u_mgal":null,"other_site":null,"text":"x","text_parts":["x"],"amendment":null}])");
}

TEST_CASE("a mistake does not decide which model is chosen") {
    const Day good;
    const std::string chosen = model::correct_survey(good.rows, {}).model;
    CHECK(chosen == "t-rate-drift");
    CHECK(judgement::correct_and_search({good.rows, good.sites, nullptr}, {}).remarks.empty());

    Day day;
    day.off(2, 100.0);
    REQUIRE(model::correct_survey(day.rows, {}).model != chosen);
    const auto result = judgement::correct_and_search({day.rows, day.sites, nullptr}, {});
    CHECK(result.model == chosen);
    REQUIRE(!result.remarks.empty());
    CHECK(result.remarks.back() ==
          "t-rate-drift is chosen from the readings without the mistakes that were found");
    CHECK(kinds(result.findings).front() == "unusable_day");

    // A model that is asked for is kept, and what is known already stays.
    const Finding known{
        .kind = FindingKind::no_stop, .code = "no_stop", .text = "S1 (1) has no stop"};
    const auto kept =
        judgement::correct_and_search({day.rows, day.sites, nullptr}, {.model = "t"}, {known});
    CHECK(kept.model == "t");
    CHECK(std::ranges::count(kept.findings, known.text, &Finding::text) == 1);
}

TEST_CASE("a step over a pause of a night is found where one constant holds for all days") {
    Day day;
    for (std::size_t i = 6; i < day.rows.size(); ++i) {
        day.rows[i].time += std::chrono::hours(20);
        day.off(i, 20.0);
    }
    const auto findings = day.findings("t-rate");
    const auto step = std::ranges::find(findings, FindingKind::step, &Finding::kind);
    REQUIRE(step != findings.end());
    CHECK(std::abs(*step->size_mgal - 20.0) < 4.0);
}
