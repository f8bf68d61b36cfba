#include "corrector/figure/gnuplot_script.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "tests/unit/figure/corrected_rows.hpp"

using namespace a351;
using namespace a351::corrector::figure;

namespace {

/// Returns the script without the commands that are the same for all figures.
std::string body_of(const Figure& figure) {
    const std::string script = script_of(figure);
    const std::size_t head = script.find("set palette");
    return script.substr(script.find('\n', head) + 1);
}

}  // namespace

TEST_CASE("a script has only the settings that differ from the panel before", "[report][script]") {
    Figure figure{"f"};
    figure.panels = {{.x = {"Hours"}, .y = {"mGal", {-1.0, kFromData}}},
                     {.y = {"mGal", {-1.0, kFromData}, 0.5}}};
    figure.plot("hours mgal", "1 1\n", {Look::thin_line, Colour::vermilion, "A"});
    figure.plot("hours mgal", "", {Look::dots}, 1);  // no data: neither a block nor a series
    figure.plot("hours mgal", "1 1\n", {Look::dots}, 1);
    CHECK(body_of(figure) ==
          "set multiplot layout 2,1\nset lmargin 12\n"
          "set xlabel 'Hours'\nset ylabel 'mGal'\nset yrange [-1:*]\n"
          "plot 'f.dat' index 0 using 1:2 with lines lw 0.7 lc rgb '#D55E00' title 'A'\n"
          "set xlabel ''\nset ytics mirror norotate 0.5\n"
          "plot 'f.dat' index 1 using 1:2 with points pt 7 ps 0.2 lc rgb '#0072B2' notitle\n"
          "unset multiplot\nunset output\n");
    CHECK(figure.data == "# hours mgal\n1 1\n\n\n# hours mgal\n1 1\n");
}

TEST_CASE("columns are shifted and scaled, and a source without data is not plotted",
          "[report][script]") {
    Figure figure{"f"};
    figure.panels.emplace_back().series = {{.source = ""},
                                           {Look::area,
                                            Colour::limits,
                                            "",
                                            {{1, 5.0, 60.0}, {2, -0.25}, {3, 0.0, 2.0}},
                                            source_of("other", 3)},
                                           {.colour = Colour::grey, .source = kZero}};
    CHECK_THAT(body_of(figure),
               StartsWith("plot 'other.dat' index 3 using ($1*60+5):($2-0.25):($3*2+0) with "
                          "filledcurves lc rgb '#e4e4e4' notitle, \\\n"
                          "     0 with lines lc rgb '#888888' notitle\n"));
}

TEST_CASE("a panel has a right axis, colours by value and room beside the data if it says so",
          "[report][script]") {
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
               ContainsSubstring("set y2label 'Right'\nset y2tics nomirror norotate autofreq\n") &&
                   ContainsSubstring("set ytics nomirror") &&
                   ContainsSubstring("plot 0 axes x1y2 with lines ") &&
                   ContainsSubstring("set cblabel 'mGal'\nset cbrange [1:2]\n") &&
                   ContainsSubstring("'a' using 1:2 with points pt 9 ps 1.1 palette notitle"));
    // The bottom of the range is given, so there is no room below it.
    CHECK_THAT(script,
               ContainsSubstring("set offsets graph 0.03, graph 0.03, graph 0.05, graph 0\n"));
}

TEST_CASE("marks of a panel are removed in the next one, on an axis of time too",
          "[report][script]") {
    const UtcTime noon = *parse_rfc3339("2026-05-01T12:00:00Z");
    Figure figure{"f"};
    figure.panels = {{.x = {.scale = Scale::time},
                      .series = {{.source = kZero}},
                      .spans = {{instant(noon), instant(noon) + 60.0, Colour::averaged}},
                      .lines = {{{instant(noon), 0.0, true}, {instant(noon), 1.0, true}}},
                      .texts = {{"a\nb", {instant(noon), 3.0, true, true}, "center"}}},
                     {.series = {{.source = kZero}}}};
    const std::string script = body_of(figure);
    CHECK_THAT(script,
               ContainsSubstring("unset object\nset object rectangle from '2026-05-01T12:00:00Z',"
                                 "graph 0 to '2026-05-01T12:01:00Z',graph 1 fc rgb '#cfe6f4'") &&
                   ContainsSubstring("set arrow from first '2026-05-01T12:00:00Z',graph 0 to first "
                                     "'2026-05-01T12:00:00Z',graph 1 nohead") &&
                   ContainsSubstring("set label 'a'.\"\\n\".'b' at first '2026-05-01T12:00:00Z',"
                                     "first 3 center offset 0,0.7"));
    const std::string second = script.substr(script.find("\nplot"));
    for (const char* const command : {"\nset xdata\n", "\nunset object\n", "\nunset arrow\n",
                                      "\nunset label\n", "\nset xtics mirror norotate autofreq\n"})
        CHECK(count(second, command) == 1);
}

TEST_CASE("panels in a frame have numbers and labels at its left and lower border only",
          "[report][script]") {
    Figure figure{"f", "", 200};
    figure.frame = {10.0, 30.0, 20.0, 40.0, 10.0, 5.0, 2};
    const Panel panel{.x = {"X"},
                      .y = {.label = "Y", .range = {-6.0, 6.0}, .step = 2.0, .format = "%g"},
                      .series = {{.source = kZero}},
                      .height_px = 15.0};
    figure.panels = {panel, panel, panel};
    const std::string script = script_of(figure);
    CHECK_THAT(script, ContainsSubstring("size 200,95 "));  // 20 + 15 + 5 + 15 + 40
    CHECK_THAT(script, ContainsSubstring("set lmargin at screen 0.05000; set rmargin at screen "
                                         "0.42500; set tmargin at screen 0.78947; set bmargin at "
                                         "screen 0.63158\nplot"));
    CHECK(count(script, "set format x ''") == 1);     // of the first panel
    CHECK(count(script, "set format x '% h'") == 1);  // again below the second
    CHECK(count(script, "set format y ''") == 1);
    CHECK(count(script, "set label 'X' at screen") == 1);
    CHECK(count(script, "set ylabel") == 0);
    // A label at the end of an axis would touch that of the panel above.
    CHECK_THAT(script, ContainsSubstring("set ytics mirror norotate -4,2,4"));
}

TEST_CASE("a number that is not finite is a gap of the data", "[report][script]") {
    CHECK(data_line("031", {1.5, std::nan(""), -INFINITY}) == "2 NaN NaN \n");
    CHECK(data_line("3", {-0.0004}, "# end\n") == "0.000 # end\n");
}
