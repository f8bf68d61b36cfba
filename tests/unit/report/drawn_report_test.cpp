#include "tests/support/path_variable.hpp"
#include "tests/unit/report/evil_report.hpp"

using namespace a351;
using namespace a351::corrector::report;

TEST_CASE(
    "without gnuplot the report has its text, scripts and data, and says that the figures "
    "are missing") {
    const test::TemporaryDirectory folder;
    const PathVariable path(folder.path());
    const Report made = report();
    const std::string reason = "figures are missing: gnuplot is not installed (not in PATH)";
    CHECK(made.warnings == std::vector<std::string>{reason});
    const std::string html = file(made, "report.html");
    CHECK_THAT(html, ContainsSubstring("<li>" + reason + "</li>") &&
                         ContainsSubstring("This figure is missing.") &&
                         ContainsSubstring("Repeated stations") && !ContainsSubstring("<svg"));
    CHECK_FALSE(file(made, "figures/day.gp").empty());
    CHECK_FALSE(file(made, "figures/day.dat").empty());
    for (const auto& [name, content] : made.files) CHECK_FALSE(name.ends_with(".svg"));
}

TEST_CASE("a failing gnuplot is reported once") {
    const test::TemporaryDirectory folder;
    write_gnuplot(folder, "echo 'no <terminal>' >&2; exit 2");
    const PathVariable path(folder.path());
    const Report made = report();
    REQUIRE(made.warnings.size() == 1);
    CHECK_THAT(made.warnings.front(), StartsWith("figures are missing: day.svg: gnuplot failed: "
                                                 "no <terminal>; ") &&
                                          EndsWith(" more such"));
    CHECK_THAT(file(made, "report.html"), ContainsSubstring("no &lt;terminal&gt;"));
}
