#include <pugixml.hpp>
#include <set>
#include "tests/support/catch.hpp"

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

TEST_CASE("an HTML table has one column for each alignment letter and escapes its cells",
          "[report][page]") {
    const Page page("");
    add_table(page.body(), "lr", {"a", "b"}, {{"<1>", ""}});
    CHECK_THAT(
        page.text(),
        ContainsSubstring(
            "<div class=\"wide\">\n<table>\n<thead>\n<tr>\n<th>a</th>\n<th class=\"r\">b</th>\n"
            "</tr>\n</thead>\n<tbody>\n<tr>\n<td>&lt;1&gt;</td>\n<td class=\"r\"></td>\n</tr>\n"));
}
