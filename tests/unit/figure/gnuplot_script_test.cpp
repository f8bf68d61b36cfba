#include "corrector/figure/gnuplot_script.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "corrector/figure/layout.hpp"
#include "corrector/figure/logarithmic_axis.hpp"
#include "tests/unit/figure/corrected_rows.hpp"

using namespace a351;
using namespace a351::corrector::figure;

namespace {

/// Returns the script without the commands that are the same for all figures, and without the lines
/// that place texts and panels.
std::string body_of(const Figure& figure) {
    const std::string script = script_of(figure);
    const std::size_t head = script.find("set palette");
    std::string body;
    std::istringstream lines(script.substr(script.find('\n', head) + 1));
    for (std::string line; std::getline(lines, line);)
        if (line.find("margin at screen") == std::string::npos &&
            line.find("set key") == std::string::npos &&
            line.find("unset key") == std::string::npos &&
            line.find("' at screen") == std::string::npos)
            body += line + '\n';
    return body;
}

}  // namespace

TEST_CASE("a script has only the settings that differ from the panel before") {
    Figure figure{"f"};
    figure.panels = {{.x = {"Hours"}, .y = {"mGal", {-1.0, kFromData}}},
                     {.y = {"mGal", {-1.0, kFromData}, 0.5}}};
    figure.plot("hours mgal", "1 1\n", {Look::thin_line, Colour::vermilion, "A"});
    figure.plot("hours mgal", "", {Look::dots}, 1);  // no data: neither a block nor a series
    figure.plot("hours mgal", "1 1\n", {Look::dots}, 1);
    CHECK(body_of(figure) ==
          "set multiplot\n"
          "set format x ''\nset yrange [-1:*]\n"
          "plot 'f.dat' index 0 using 1:2 with lines lw 1 lc rgb '#D55E00' title 'A'\n"
          "set format x '% h'\nset ytics mirror norotate 0.5\nunset label\n"
          "plot 'f.dat' index 1 using 1:2 with points pt 7 ps 0.12 lc rgb '#0072B2' notitle\n"
          "unset multiplot\nunset output\n");
    CHECK(figure.data == "# hours mgal\n1 1\n\n\n# hours mgal\n1 1\n");
}

TEST_CASE("columns are named by number, and a source without data is not plotted") {
    Figure figure{"f"};
    figure.panels.emplace_back().series = {
        {.source = ""},
        {Look::area, Colour::limits, "", {1, 4, 3}, source_of("other", 3)},
        {.colour = Colour::grey, .source = kZero}};
    CHECK_THAT(body_of(figure), StartsWith("plot 'other.dat' index 3 using 1:4:3 with "
                                           "filledcurves lc rgb '#e4e4e4' notitle, \\\n"
                                           "     0 with lines lw 1.5 lc rgb '#888888' notitle\n"));
}

TEST_CASE("a panel has a right axis, colours by value and room beside the data if it says so") {
    Figure figure{"f"};
    Panel& panel = figure.panels.emplace_back();
    panel = {.y = {.range = {0.0, kFromData}},
             .series = {{.source = kZero, .is_right = true},
                        {.look = Look::triangles, .colour = Colour::by_value, .source = "'a'"}},
             .right = {"Right"},
             .colours = {"mGal", {1.0, 2.0}},
             .has_margin = true};
    const std::string script = body_of(figure);
    CHECK_THAT(script,
               ContainsSubstring("set y2tics nomirror norotate autofreq\n") &&
                   ContainsSubstring("set ytics nomirror") &&
                   ContainsSubstring("plot 0 axes x1y2 with lines ") &&
                   ContainsSubstring("set cbrange [1:2]\n") &&
                   ContainsSubstring("'a' using 1:2 with points pt 9 ps 0.8 palette notitle"));
    // The bottom of the range is given, so there is no room below it.
    CHECK_THAT(script,
               ContainsSubstring("set offsets graph 0.03, graph 0.03, graph 0.05, graph 0\n"));
}

TEST_CASE("marks of a panel are removed in the next one, on an axis of time too") {
    const UtcTime noon = *parse_rfc3339("2026-05-01T12:00:00Z");
    Figure figure{"f"};
    figure.panels = {{.x = {.scale = Scale::time},
                      .series = {{.source = kZero}},
                      .spans = {{instant(noon), instant(noon) + 60.0, Colour::averaged}},
                      .lines = {{{instant(noon), 0.0, true}, {instant(noon), 1.0, true}}},
                      .texts = {{"a\nb", {instant(noon), 0.5, true}, "center"}}},
                     {.series = {{.source = kZero}}}};
    const std::string script = body_of(figure);
    CHECK_THAT(script,
               ContainsSubstring("unset object\nset object rectangle from '2026-05-01T12:00:00Z',"
                                 "graph 0 to '2026-05-01T12:01:00Z',graph 1 fc rgb '#cfe6f4'") &&
                   ContainsSubstring("set arrow from first '2026-05-01T12:00:00Z',graph 0 to first "
                                     "'2026-05-01T12:00:00Z',graph 1 nohead") &&
                   ContainsSubstring("set label 'a'.\"\\n\".'b' at first '2026-05-01T12:00:00Z',"
                                     "graph 0.5 center font"));
    const std::string second = script.substr(script.find("\nplot"));
    for (const char* const command : {"\nset xdata\n", "\nunset object\n", "\nunset arrow\n",
                                      "\nunset label\n", "\nset xtics mirror norotate autofreq\n"})
        CHECK(count(second, command) == 1);
}

TEST_CASE("panels of a column share the x axis, those of several columns the y axis too") {
    Figure figure{"f", "", 170.0};
    const Panel panel{.x = {"X"},
                      .y = {.label = "Y", .range = {-6.0, 6.0}, .step = 2.0, .format = "%g"},
                      .series = {{.source = kZero}},
                      .heading = "H"};
    figure.panels = {panel, panel, panel};
    const std::string column = script_of(figure);
    CHECK(count(column, "set format x ''") == 1);
    CHECK(count(column, "set format x '% h'") == 1);  // below the third
    for (const char* const heading : {"'(a) Y'", "'(b) Y'", "'(c) Y'"})
        CHECK(count(column, heading) == 1);
    CHECK(count(column, "set label 'X' at screen") == 1);

    figure.columns = 2;
    const std::string script = script_of(figure);
    CHECK(count(script, "set format x ''") == 1);     // of the first panel
    CHECK(count(script, "set format x '% h'") == 1);  // again below the second
    CHECK(count(script, "set format y ''") == 1);
    CHECK(count(script, "set label 'X' at screen") == 1);
    CHECK(count(script, "set label 'Y' at screen") == 1);
    CHECK(count(script, "set label 'H' at screen") == 3);
}

TEST_CASE("texts above a panel get as many lines as they need") {
    Figure figure{"f", "", kColumn_mm};
    Panel& panel = figure.panels.emplace_back();
    panel.y.label = "Heading";
    panel.note = "note";
    panel.x.range = {0.0, 10.0};
    const auto place = [&] { return layout_of(figure).panels.front(); };
    const double alone = place().top;
    CHECK(place().note == place().heading);

    panel.note = std::string(40, 'n');
    CHECK(place().note == Approx(place().heading + kTextLine_mm));
    CHECK(place().top == Approx(alone + kTextLine_mm));

    // The second name touches the first; the third has room beside it.  The lowest row is last.
    panel.note = "";
    panel.names = {{1.0, "No.1"}, {1.5, "No.2"}, {3.0, "No.3"}};
    const std::vector<double> rows = place().names;
    CHECK(rows[0] == rows[2]);
    CHECK(rows[1] == Approx(rows[0] - kTextLine_mm));
    CHECK(place().top == Approx(alone + 2.0 * kTextLine_mm));

    panel.names.assign(9, {5.0, "same"});
    CHECK(std::ranges::count_if(place().names, [](double y) { return std::isnan(y); }) == 3);

    panel.names.clear();
    panel.series.assign(4, {.label = std::string(20, 'k'), .source = kZero});
    CHECK(place().key_rows == 4);
    figure.width_mm = kPage_mm;
    CHECK(place().key_rows == 2);
}

TEST_CASE("a logarithmic axis of less than three decades has ticks of our own") {
    CHECK(logarithmic_ticks({0.9, 21.0}) ==
          "('' 0.9 1, 1, 2, '' 3 1, '' 4 1, 5, '' 6 1, '' 7 1, '' 8 1, '' 9 1, 10, 20)");
    CHECK_THAT(logarithmic_ticks({0.1, 99.0}), StartsWith("(0.1, '' 0.2 1,"));
    CHECK(logarithmic_ticks({0.3, 0.7}) == "(0.3, 0.4, 0.5, 0.6, 0.7)");
    CHECK(logarithmic_ticks({0.31, 0.39}).empty());
    CHECK(logarithmic_ticks({0.1, 100.0}).empty());
    CHECK(logarithmic_ticks({kFromData, kFromData}).empty());

    Figure figure{"f", "", kColumn_mm};
    Panel& panel = figure.panels.emplace_back();
    panel.x = {.label = "x - 1", .range = {0.008, 0.3}, .scale = Scale::logarithmic};
    panel.y = {.label = "- y", .scale = Scale::logarithmic};
    panel.colours = {.label = "z", .scale = Scale::logarithmic};
    figure.plot("other", "1 1e9 \n", {});
    panel.series.clear();
    figure.plot("x y low high", "0.01 30 NaN 0 \n\n0.02 0.4 0.02 500 \n",
                {.columns = {1, 2, 3, 4}});
    figure.plot("x y z", "0.01 1 7 \n", {.colour = Colour::by_value, .columns = {1, 2, 3}});
    figure.plot("x y u", "0.01 1 1e6 \n", {.look = Look::bars, .columns = {1, 2, 3}});
    figure.plot("x right", "0.01 1e6 \n", {.is_right = true});
    const std::string script = script_of(figure);
    CHECK_THAT(
        script,
        ContainsSubstring("set xtics mirror norotate ('' 0.008 1, '' 0.009 1, 0.01, 0.02, ") &&
            ContainsSubstring("set yrange [0.01:1000]\n") &&
            ContainsSubstring("set cbrange [1:10]\n") && !ContainsSubstring("set ytics"));
    // Their labels have a minus sign in place of a hyphen.
    CHECK_THAT(script, ContainsSubstring("'x \u2212 1'") && ContainsSubstring("'\u2212 y'"));
}

TEST_CASE("all formats have the width and the letters that print_style.hpp says") {
    Figure figure{"f", "", kColumn_mm};
    figure.panels.emplace_back().series = {{.source = kZero}};
    const std::string script = script_of(figure);
    // 84 mm are 317 px, 3.307 in and 992 dots; 7.5 pt are 10 px.
    CHECK_THAT(script, ContainsSubstring("svg noenhanced size 317,") &&
                           ContainsSubstring("pdfcairo noenhanced size 3.307in,") &&
                           ContainsSubstring("pngcairo noenhanced size 992,"));
    CHECK(count(script, "font 'sans-serif,10'") == 3);
}

TEST_CASE("a number that is not finite is a gap of the data") {
    CHECK(data_line("031", {1.5, std::nan(""), -INFINITY}) == "2 NaN NaN \n");
    CHECK(data_line("3", {-0.0004}, "# end\n") == "0.000 # end\n");
}
