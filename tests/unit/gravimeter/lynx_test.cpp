// Files of Lynx LG, the program of the CG-6.
#include "corrector/gravimeter/columns.hpp"
#include "corrector/gravimeter/stays.hpp"

#include "tests/unit/gravimeter/made_up_lines.hpp"

using namespace a351;
using namespace a351::corrector::gravimeter;
using namespace made_up;

namespace {

constexpr const char* kLynxHeader =
    "/ CG-6 Gravity Survey\n/ Software Version: 2.1\n/ Meter: 042\n/ Tidal Correction: Enabled\n";

/// Returns a reading of Lynx LG.
/// @param names  survey, station, occupation and line between single blanks.
std::string lynx_reading(const std::string& names, const std::string& minute = "10") {
    return "2024  6 12  9 " + minute + "  5   0 " + names +
           " 47.2456627 10.7404137 812.4 2801.5012 0.0013 0.0102 -1.1 0.5 1.4 0.0004 -0.0312 "
           "0.0002 0.1800 -2.3870 47.2456 10.7404  1 12 0.87 861.5  60  3 0.213 0.0\n";
}

/// Returns the names of the columns of Lynx LG as its header has them.
std::string lynx_names() {
    std::string names = "/ Column Headers:\n";
    for (const auto name : usual_names(Form::cg6_lynx)) names += "/ " + std::string(name) + "\n";
    return names;
}

}  // namespace

TEST_CASE("a file of Lynx LG has its stations in the lines, and an empty occupation or line") {
    const std::string header = kLynxHeader;
    const auto reading = [](const std::string& stay, const std::string& minute) {
        return lynx_reading("north P1 " + stay, minute);
    };
    const auto [stay, stay_number, line_name, note] =
        GENERATE(table<std::string, std::string, std::string, std::string>({
            {"2 7", "2", "7", ""},
            {" 7", "", "7", ""},
            {"2 ", "2", "", ""},
            {" ", "", "", "/ Notes: wind\n"},
        }));
    const auto file = read(header + note + reading(stay, "10") + reading(stay, "11"));
    CHECK(file.format == "Scintrex CG-6");
    CHECK(file.layout ==
          std::string("Lynx LG, 35 columns in the usual order, without a line of names") +
              (note.empty() ? "" : ", with notes"));
    REQUIRE(file.readings.size() == 2);
    const Reading& first = file.readings[0];
    CHECK(first.instrument == "CG-6 042");
    CHECK(first.site == "P1");
    CHECK(to_rfc3339(first.time, 3) == "2024-06-12T09:10:05.000Z");
    CHECK(first.value == MilliGal(2801.5012));
    CHECK(first.tide_correction == MilliGal(-0.0312));
    CHECK(first.height == Metres(0.213));
    CHECK(kept(first, "sd_mgal") == "0.0102");
    CHECK(kept(first, "stay_number") == stay_number);
    CHECK(kept(first, "line_name") == line_name);
    CHECK(kept(first, "note") == (note.empty() ? "not kept" : "wind"));

    std::string names = lynx_names();
    CHECK(read(header + names + "/ \n" + reading(stay, "10"))
              .layout.starts_with("Lynx LG, 35 columns, by name"));
    names.replace(names.find("StdErr(mGals)"), 13, "Err");
    CHECK(read(header + names + "/ \n" + reading(stay, "10"))
              .layout.starts_with("Lynx LG, 35 columns, by their order"));
    names.replace(names.find("/ Err\n/ StdDev(mGals)"), 21, "/ StdDev(mGals)\n/ Err");
    CHECK_THROWS_WITH(read(header + names + "/ \n" + reading(stay, "10")),
                      ContainsSubstring("unknown columns: Err"));
}

TEST_CASE("a blank in a name of Lynx LG does not hide behind an empty cell") {
    const auto [names, is_read] = GENERATE(table<std::string, bool>({
        {"north P1 2 7", true},
        {" P1 2 7", true},            // without a survey
        {"north area P1 2 ", false},  // 35 cells between any blanks, with station "area"
        {"north P 1  7", false},      // the same, with station "P"
        {"north area P1  ", false},   // 34 cells
    }));
    const std::string content = kLynxHeader + lynx_reading(names);
    if (is_read)
        CHECK(read(content).readings.front().site == "P1");
    else
        CHECK_THROWS_WITH(read(content), ContainsSubstring("between single blanks"));
}

TEST_CASE("columns of Lynx LG are taken by their order only with the names of what is computed") {
    const std::string name =
        GENERATE("Station", "Minute", "CorrGravity(mGals)", "TidalCorr(mGals)");
    const std::string names = changed(lynx_names(), "/ " + name + "\n", "/ Other\n");
    CHECK_THROWS_WITH(read(kLynxHeader + names + "/ \n" + lynx_reading("north P1 2 7")),
                      ContainsSubstring("unknown columns: "));
}

TEST_CASE("a second header of Lynx LG leaves nothing of the first") {
    const std::string line = lynx_reading("north P1 2 7");
    const std::string start = kLynxHeader + lynx_names() + "/ \n" + line;
    const std::string names = changed(lynx_names(), "TidalCorr(mGals)", "Other");
    const auto other_names = read(start + names + "/ \n" + line);
    REQUIRE(other_names.refused.size() == 1);
    CHECK_THAT(other_names.refused[0].reason, ContainsSubstring("unknown columns: Other"));
    const auto other_meter = read(start + "/ CG-6 Gravity Survey\n" + line);
    REQUIRE(other_meter.refused.size() == 1);
    CHECK_THAT(other_meter.refused[0].reason, ContainsSubstring("no header with Meter"));
}
