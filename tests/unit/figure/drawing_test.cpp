#include "corrector/figure/drawing.hpp"

#include "tests/support/catch.hpp"

#include "protocol/child/child_program.hpp"
#include "tests/support/path_variable.hpp"

using namespace a351;
using namespace a351::corrector::figure;

namespace {

/// Returns a figure of a file's first block, with a text as title.
Figure figure(const std::string& name, const std::string& file, const std::string& title = "") {
    Figure figure{name, "", kColumn_mm};
    figure.panels.emplace_back().series = {{.source = "'" + file + "'"}};
    figure.panels.back().note = title;
    figure.data = "1 1\n2 4\n";
    return figure;
}

bool has_gnuplot() {
    if (child::run_child({.words = {"gnuplot", "--version"}}).outcome == child::Outcome::good)
        return true;
    WARN("gnuplot is not installed: nothing is drawn");
    return false;
}

}  // namespace

TEST_CASE("drawing the same figures gives the same bytes in every format") {
    if (!has_gnuplot()) return;
    const std::vector<Figure> figures{figure("one", "one.dat"), figure("two", "two.dat")};
    const Drawing drawing = draw(figures, picture_formats());
    CHECK(drawing.troubles.empty());
    REQUIRE(drawing.pictures.size() == 6);
    CHECK(drawing.pictures[1].first == "two.svg");
    CHECK(drawing.pictures[2].second.starts_with("%PDF"));
    CHECK(drawing.pictures[2].second.find("/CreationDate (D:19700101000000Z") != std::string::npos);
    CHECK(drawing.pictures[4].second.substr(1, 3) == "PNG");
    CHECK(draw(figures, picture_formats()).pictures == drawing.pictures);
}

TEST_CASE("a bad figure is reported and does not affect the others") {
    if (!has_gnuplot()) return;
    const Drawing drawing =
        draw({figure("one", "one.dat"), figure("bad", "absent.dat"), figure("two", "one.dat")}, {});
    REQUIRE(drawing.pictures.size() == 2);
    CHECK(drawing.pictures[1].first == "two.svg");
    REQUIRE(drawing.troubles.size() == 1);
    CHECK_THAT(drawing.troubles.front(), StartsWith("bad.svg: gnuplot failed: \"bad.gp\" line ") &&
                                             EndsWith("No data in plot"));
}

TEST_CASE("a name from an input file is drawn literally and executes nothing") {
    if (!has_gnuplot()) return;
    const test::TemporaryDirectory folder;
    const std::string trap = (folder.path() / "trap").string();
    const std::string name = "It's `touch " + trap + "` @a {/x} ^2 \\n %s";
    Figure one = figure("one", "one.dat", name);
    Panel& panel = one.panels.front();
    panel.texts = {{"'; system('touch " + trap + "'); #", {0.5, 0.5}}};
    panel.x.label = panel.y.label = panel.series.front().label = name;
    panel.x.names = {{1.0, name}};
    const Drawing drawing = draw({one}, {});
    REQUIRE(drawing.pictures.size() == 1);
    CHECK_THAT(drawing.pictures.front().second,
               ContainsSubstring("`touch ") && ContainsSubstring("@a {/x} ^2 \\n %s"));
    CHECK_FALSE(std::filesystem::exists(trap));
}

TEST_CASE("a missing or failing gnuplot gives exactly one reason") {
    const std::vector<Figure> figures{figure("one", "one.dat")};
    const test::TemporaryDirectory folder;
    const PathVariable path(folder.path());
    CHECK(draw(figures, {}).troubles ==
          std::vector<std::string>{"gnuplot is not installed (not in PATH)"});
    write_gnuplot(folder, "echo 'no such terminal' >&2; exit 4");
    const Drawing drawing = draw(figures, {});
    CHECK(drawing.pictures.empty());
    CHECK(drawing.troubles ==
          std::vector<std::string>{"one.svg: gnuplot failed: no such terminal"});
    write_gnuplot(folder, "exit 0");
    CHECK(draw(figures, {}).troubles ==
          std::vector<std::string>{"one.svg: gnuplot did not write it"});
}
