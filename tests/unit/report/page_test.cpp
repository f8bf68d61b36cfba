#include <pugixml.hpp>
#include <regex>
#include <set>

#include "corrector/report/html.hpp"
#include "tests/unit/report/evil_report.hpp"

using namespace a351;
using namespace a351::corrector::report;

namespace {

void collect_ids(const pugi::xml_node& node, std::multiset<std::string>& ids) {
    if (node.attribute("id")) ids.insert(node.attribute("id").value());
    for (const pugi::xml_node child : node.children()) collect_ids(child, ids);
}

}  // namespace

TEST_CASE("the report is well-formed and self-contained, whatever names it contains") {
    const Report made = report();
    const std::string html = file(made, "report.html");
    pugi::xml_document document;
    REQUIRE(document.load_string(html.c_str()));
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

TEST_CASE("the same survey gives the same report") { CHECK(report().files == report().files); }

TEST_CASE("the contents link to every section of the page") {
    pugi::xml_document document;
    REQUIRE(document.load_string(file(report(), "report.html").c_str()));
    std::vector<std::string> links, sections;
    for (const auto& link : document.select_nodes("//nav//a"))
        links.emplace_back(link.node().attribute("href").value());
    for (const auto& title : document.select_nodes("//h2"))
        sections.push_back('#' + std::string(title.node().attribute("id").value()));
    CHECK(links == sections);
    CHECK(links.size() >= 5);
}

TEST_CASE("the caption of each table and figure with errors says of which kind they are") {
    pugi::xml_document document;
    REQUIRE(document.load_string(file(report(), "report.html").c_str()));
    const std::regex errors(
        "(Residual|Error|RMS|LOO|LOSO|s mGal|Standard error|u|u mGal|t|Kind).*");
    const std::regex kinds(".*(in sample|left out|[Cc]ross-validated|\\bu\\b).*");
    std::size_t checked = 0;
    for (const auto& found : document.select_nodes("//table|//*[local-name()='svg']")) {
        const pugi::xml_node figure = found.node().parent();
        const std::string caption = figure.child("figcaption").text().get();
        CAPTURE(caption);
        REQUIRE(figure.name() == std::string("figure"));
        CHECK_FALSE(caption.empty());
        bool has_errors = false;
        for (const auto& cell : found.node().select_nodes("thead//th"))
            has_errors =
                has_errors || std::regex_match(std::string(cell.node().child_value()), errors);
        if (!has_errors) continue;
        CHECK(std::regex_match(caption, kinds));
        ++checked;
    }
    CHECK(checked >= 5);
}

TEST_CASE("an HTML table has one column for each alignment letter and escapes its cells") {
    const Page page("");
    add_table(page.body(), "u & v", "lr", {"a", "b"}, {{"<1>", ""}});
    CHECK_THAT(
        page.text(),
        ContainsSubstring(
            "<figure class=\"table\">\n<figcaption>u &amp; "
            "v</figcaption>\n<table>\n<thead>\n<tr>\n<th>a</th>\n<th class=\"r\">b</th>\n"
            "</tr>\n</thead>\n<tbody>\n<tr>\n<td>&lt;1&gt;</td>\n<td class=\"r\"></td>\n</tr>\n"));
}
