#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "corrector/report/html.hpp"
#include "corrector/report/report.hpp"
#include "tests/unit/model/survey_rows.hpp"
#include "tests/unit/report/path_variable.hpp"

using namespace a351;
using namespace a351::corrector;

namespace {

const std::string kEvil = "<script>&'\"`x`\xFF";

SurveyCorrection result_with_evil_name() {
    auto rows = made_up::day();
    rows[3].site = kEvil;
    rows[3].notes = {"</td>" + kEvil};
    rows[3].acceleration = rows[3].acceleration + MilliGal(1.0);
    SurveyOptions options;
    options.model = "t-rate-drift";
    return correct_survey(rows, options);
}

ReportSources sources() {
    ReportSources sources;
    sources.title = "day & night " + kEvil;
    sources.sites = {{kEvil, Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979800.0)}};
    sources.inputs = {{"sites", "<sites>.csv", 12, 0x00ABCDEF}};
    sources.warnings = {"<B> is left out"};
    return sources;
}

Report report() {
    nlohmann::ordered_json settings;
    settings["model"] = "<auto>";
    settings["datum"] = {kEvil};
    settings["warnings"] = {"not twice"};
    return make_report(result_with_evil_name(), settings, sources());
}

const std::string& file(const Report& report, const std::string& name) {
    for (const auto& [file_name, content] : report.files) {
        if (file_name == name) return content;
    }
    FAIL(name + " is missing");
    return report.files.front().second;
}

void collect_ids(const pugi::xml_node& node, std::multiset<std::string>& ids) {
    if (node.attribute("id")) ids.insert(node.attribute("id").value());
    for (const pugi::xml_node child : node.children()) collect_ids(child, ids);
}

}  // namespace

TEST_CASE("the report is well-formed and self-contained, whatever names it contains",
          "[report][page]") {
    const Report made = report();
    const std::string html = file(made, "report.html");
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_string(html.c_str());
    INFO(parsed.description());
    REQUIRE(parsed);
    CHECK(std::string(document.child("html").child("head").child_value("title")) ==
          "Gravity survey day & night <script>&'\"`x`\uFFFD");
    CHECK(html.find("<script") == std::string::npos);
    CHECK(html.find("src=") == std::string::npos);
    CHECK(html.find("href=\"http") == std::string::npos);
    std::multiset<std::string> ids;
    collect_ids(document, ids);
    CHECK(std::set<std::string>(ids.begin(), ids.end()).size() == ids.size());
    CHECK_THAT(html, ContainsSubstring("&lt;/td&gt;&lt;script&gt;") &&
                         ContainsSubstring("<td class=\"r\">00abcdef</td>") &&
                         ContainsSubstring("&lt;B&gt; is left out") &&
                         ContainsSubstring("<td>&lt;auto&gt;</td>") &&
                         !ContainsSubstring("not twice"));
}

TEST_CASE("the same survey gives the same report", "[report][page]") {
    CHECK(report().files == report().files);
}

TEST_CASE(
    "without gnuplot the report has its text, scripts and data, and says that the figures are "
    "missing",
    "[report][page]") {
    const test::TemporaryDirectory folder;
    const PathVariable path(folder.path());
    const Report made = report();
    const std::string reason = "figures are missing: gnuplot is not installed (not in PATH)";
    CHECK(made.warnings == std::vector<std::string>{reason});
    const std::string html = file(made, "report.html");
    CHECK_THAT(html, ContainsSubstring("<li>" + reason + "</li>") &&
                         ContainsSubstring("This figure is missing.") &&
                         ContainsSubstring("Repeated stations") && !ContainsSubstring("<svg"));
    CHECK_FALSE(file(made, "figures/residuals.gp").empty());
    CHECK_FALSE(file(made, "figures/residuals.dat").empty());
    for (const auto& [name, content] : made.files) CHECK_FALSE(name.ends_with(".svg"));
}

TEST_CASE("a failing gnuplot is reported once", "[report][page]") {
    const test::TemporaryDirectory folder;
    write_gnuplot(folder, "echo 'no <terminal>' >&2; exit 2");
    const PathVariable path(folder.path());
    const Report made = report();
    REQUIRE(made.warnings.size() == 1);
    CHECK_THAT(made.warnings.front(),
               StartsWith("figures are missing: corrected.svg: gnuplot ended with status "
                          "2: no <terminal>; ") &&
                   EndsWith(" more such"));
    CHECK_THAT(file(made, "report.html"), ContainsSubstring("no &lt;terminal&gt;"));
}

TEST_CASE("an HTML table has one column for each alignment letter and escapes its cells",
          "[report][page]") {
    CHECK(html_table("lr", {"a", "b"}, {{"<1>", "2"}}) ==
          "<div class=\"wide\"><table>\n<thead><tr><th>a</th><th class=\"r\">b</th></tr>\n"
          "</thead>\n<tbody>\n<tr><td>&lt;1&gt;</td><td class=\"r\">2</td></tr>\n"
          "</tbody></table></div>\n");
}
