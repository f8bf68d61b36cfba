#include "corrector/gravimeter/gravimeter_file.hpp"
#include "corrector/gravimeter/columns.hpp"
#include "corrector/gravimeter/stays.hpp"

#include <fmt/core.h>

#include "protocol/core/input_error.hpp"
#include "tests/unit/gravimeter/made_up_lines.hpp"

using namespace a351;
using namespace a351::corrector::gravimeter;
using namespace made_up;

TEST_CASE("a CG-5 west of Greenwich has its time in UTC, its position and its columns") {
    const auto file = read(cg5_header("4.0") + cg5_reading("16.0000000", "23:30:00"));
    CHECK(file.format == "Scintrex CG-5");
    CHECK(file.comment_count == 8);
    REQUIRE(file.readings.size() == 1);
    const Reading& reading = file.readings[0];
    CHECK(reading.instrument == "CG-5 123");
    CHECK(reading.site == "16");
    CHECK(to_rfc3339(reading.time) == "2013-09-16T03:30:00Z");
    CHECK(reading.value == MilliGal(2000.0));
    CHECK(reading.tide_correction == MilliGal(0.02));
    CHECK(reading.position->latitude == Degrees(-33.25));
    CHECK(reading.position->longitude == Degrees(-70.5));
    CHECK(kept(reading, "tilt_y_arcsec") == "-0.2");
    CHECK(kept(reading, "temperature_offset_mk") == "-1.5");
}

TEST_CASE(
    "a CG-5 without its tide correction has none, and a second header changes the instrument") {
    const auto file = read(cg5_header("0.0") + cg5_reading("1", "10:00:00") +
                           cg5_header("-1.0", "NO", "456") + cg5_reading("1", "10:00:00"));
    REQUIRE(file.readings.size() == 2);
    CHECK(file.readings[0].tide_correction.has_value());
    CHECK_FALSE(file.readings[1].tide_correction.has_value());
    CHECK(file.readings[1].instrument == "CG-5 456");
    CHECK(to_rfc3339(file.readings[1].time) == "2013-09-15T09:00:00Z");
}

TEST_CASE("a coordinate in the header of a CG-5 that is none is refused") {
    const auto refused = [](const std::string& from, const std::string& to) {
        std::string reasons;
        for (const RefusedLine& line :
             read(changed(cg5_header("0.0") + cg5_reading("1", "10:00:00"), from, to)).refused)
            reasons += line.reason + ";";
        return reasons;
    };
    CHECK(refused("33.25 S", "90.0 S").find("LAT") == std::string::npos);
    CHECK_THAT(refused("33.25 S", "140.1 N"), StartsWith("LAT: not as a CG-5 writes it"));
    CHECK_THAT(refused("33.25 S", "33.25 E"), StartsWith("LAT: not as a CG-5 writes it"));
    CHECK_THAT(refused("70.5 W", "180.5 W"), StartsWith("LONG: not as a CG-5 writes it"));
}

TEST_CASE("a CG-6 gives its own tide only if it was applied, and the receiver's position") {
    const auto file = read(cg6_header() + cg6_reading("A 1", "10:00:00") +
                           cg6_reading("A 1", "10:01:00", "11001"));
    CHECK(file.format == "Scintrex CG-6");
    REQUIRE(file.readings.size() == 2);
    CHECK(file.readings[0].site == "A 1");
    CHECK(file.readings[0].tide_correction == MilliGal(-0.0488));
    CHECK_FALSE(file.readings[1].tide_correction.has_value());
    CHECK(file.readings[0].height == Metres(0.25));
    CHECK(file.readings[0].position->longitude == Degrees(-105.0));
    CHECK(kept(file.readings[0], "temperature_degc") == "43.2662");
}

TEST_CASE("a word of the names elsewhere in a line of a CG-6 is no line of names") {
    const std::string reading =
        changed(cg6_reading("A", "10:00:00"), "2066.1898\t1", "2066.1898\tStation");
    const auto file = read("/\tCG-6 Survey\n/\tSurvey Name:\tStation\n" + cg6_header().substr(15) +
                           reading + cg6_reading("B", "10:01:00"));
    CHECK(file.refused.empty());
    REQUIRE(file.readings.size() == 2);
    CHECK(kept(file.readings[0], "line_name") == "Station");
}

TEST_CASE("a Burris is read with blanks or commas") {
    const char separator = GENERATE(' ', ',', '\t');
    const auto file = read(burris_reading("rg37", "15:56:20", "2800", separator));
    CHECK(file.format == "ZLS Burris");
    REQUIRE(file.readings.size() == 1);
    CHECK(file.readings[0].dial == "2800");
    CHECK(file.readings[0].tide_correction == MilliGal(-0.103));
    CHECK(file.readings[0].height == Metres(0.1));
    CHECK(kept(file.readings[0], "tilt_correction_mgal") == "0.005");
}

TEST_CASE("a Burris is read with 15 columns, with a note, and with quoted or empty cells") {
    const auto [line, layout] = GENERATE(table<std::string, std::string>({
        {"a B44 2017/12/05 10:00:00 2769.695 2800 0.482 -0.103 0.005 -0.033 -0.002 0.1 1600 35.1 "
         "-106.6",
         "15 columns in the usual order, without a line of names"},
        {"a b,o,B44,2017/12/05,10:00:00,2769.695,2800,0.482,-0.103,0.005,-0.033,-0.002,0.1,1600,"
         "35.1,-106.6,96,0.003,120,wind, then rain",
         "20 columns in the usual order, without a line of names"},
        {"a b,o,B44,2017/12/05,10:00:00,2769.695,2800,0.482,-0.103,0.005,-0.033,-0.002,0.1,1600,"
         "35.1,-106.6,96,0.003,120,,rain",
         "20 columns in the usual order, without a line of names"},
        {"\"a\",\"o\",\"B44\",2017/12/"
         "05,10:00:00,2769.695,2800,0.482,-0.103,0.005,-0.033,-0.002,0.1,"
         "1600,35.1,-106.6",
         "16 columns in the usual order, without a line of names"},
        {"a\t\tB44\t2017/12/5\t10:00:00\t2769.695\t2800\t0.482\t-0.103\t0.005\t-0.033\t-0.002\t"
         "0.1\t1600\t35.1\t-106.6",
         "16 columns in the usual order, without a line of names"},
    }));
    const auto file = read(line + "\n" + line + "\n");
    CHECK(file.layout == layout);
    REQUIRE(file.readings.size() == 2);
    CHECK(file.readings[0].instrument == "B44");
    CHECK(file.readings[0].value == MilliGal(2769.695));
    CHECK(file.readings[0].position->longitude == Degrees(-106.6));
    CHECK(to_rfc3339(file.readings[0].time) == "2017-12-05T10:00:00Z");
}

TEST_CASE("a Burris with the year last is read if a day above 12 proves that the month is first") {
    const auto dated = [](const std::string& date) {
        return changed(burris_reading("a", "10:00:00"), "2017/12/05", date);
    };
    const auto file = read(dated("05/12/2017") + dated("5/13/2017"));
    REQUIRE(file.readings.size() == 2);
    CHECK(to_rfc3339(file.readings[0].time) == "2017-05-12T10:00:00Z");
    CHECK_THAT(file.layout, ContainsSubstring("dates read as month/day/year"));
    CHECK_THROWS_WITH(read(dated("05/12/2017") + dated("06/12/2017")),
                      ContainsSubstring("month and day can be either"));
    CHECK_THROWS_WITH(read(dated("05/12/2017") + dated("13/12/2017")),
                      ContainsSubstring("month and day can be either"));
}

TEST_CASE("a Burris between blanks whose observer is a number is refused, because a station can "
          "have a blank") {
    std::string line = changed(burris_reading("BM", "10:00:00"), "abc", "1");
    CHECK_THROWS_WITH(read(line + line), ContainsSubstring("Observer ID = 1: a number"));
    for (char& letter : line)
        if (letter == ' ') letter = ',';
    CHECK(read(line).readings.front().site == "BM");
}

TEST_CASE("a Burris between blanks with further words in its names is refused by its columns") {
    const auto with = [](const std::string& station, const std::string& observer) {
        return changed(burris_reading(station, "10:00:00"), "abc", observer);
    };
    for (const std::string& line :
         {with("North Hill", "abc"), with("BM", "a b"), with("a b c", "d")})
        CHECK_THROWS_WITH(read(line), ContainsSubstring("columns; allowed: 15, 16 or 20, and names "
                                                        "without blanks, or commas or tabs"));
    // The second word of a station can be the observer: all of them are listed.
    const std::string one = with("North", "Hill"), other = with("South", "Gate");
    CHECK_THAT(read(one + other).layout,
               ContainsSubstring("observers, if not second words of stations: Gate, Hill"));
    CHECK_THAT(read(one).layout, !ContainsSubstring("observers"));
}

TEST_CASE("a Burris is read by the names of its columns if the station is not the first") {
    const auto file = read(
        "Observer ID,Station ID,Serial Number,Date,Time,ObsG,Dial,Earthtide Correction\n"
        "me,P1,B44,2017/12/05,10:00:00,2769.695,2800,-0.103\n");
    CHECK(file.refused.empty());
    CHECK(file.readings.front().site == "P1");
}

TEST_CASE("a Burris can have a comma in a quoted name, and its names in other capitals are names") {
    const std::string names = "Station ID,Serial Number,Date,Time,ObsG,Dial,Earthtide Correction\n";
    const auto file = read(names + "\"Well 1, north\",B44,2017/12/05,10:00:00,2770.5,2800,-0.1\n");
    CHECK(file.refused.empty());
    CHECK(file.readings.front().site == "Well 1, north");

    std::string small = names + "a,B44,2017/12/05,10:00:00,2770.5,2800,-0.1\n";
    for (char& letter : small)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter + 32);
    CHECK_THROWS_WITH(read(small + burris_reading("a", "10:00:00")),
                      ContainsSubstring(":1: unknown columns: station id"));
}

TEST_CASE("columns without a name, as a spreadsheet adds at the end, are not used") {
    const GravimeterFile file = read(
        "Station ID,Serial Number,Date,Time,ObsG,Dial,Earthtide Correction,,\n"
        "a,B44,2017/12/05,10:00:00,2770.5,2800,-0.1,,\n"
        "b,B44,2017/12/05,10:20:00,2770.6,2800,-0.1,,x\n"
        "c,B44,2017/12/05,10:40:00,2770.7,2800,-0.1\n");
    CHECK(file.readings.size() == 2);
    REQUIRE(file.refused.size() == 1);
    CHECK(file.refused[0].line == 4);
}

TEST_CASE("a line of names with columns that nobody knows is refused with their names") {
    const std::string cg6 = changed(cg6_header(), "TideCorr", "SeaLevel");
    const auto [content, line,
                reason] = GENERATE_COPY(table<std::string, std::size_t, std::string>({
        {cg6 + cg6_reading("A", "10:00:00") + cg6_header() + cg6_reading("A", "10:00:00"), 4,
         "unknown columns: SeaLevel; missing columns: TideCorr"},
        {cg5_header("0.0") + "/---LINE---LAT---ALT.---GRAV.---TIDE---TIME---DATE\r\n" +
             cg5_header("0.0") + cg5_reading("1", "10:00:00"),
         9, "missing columns: STATION"},
        {"Station ID,Serial Number,Date,Time,ObsG,Dial,Dial,Wind\n" +
             burris_reading("a", "10:00:00"),
         1, "unknown columns: Wind; repeated columns: Dial; missing columns: Earthtide Correction"},
    }));
    GravimeterFile file;
    try {
        file = read(content);
    } catch (const InputError& error) {  // the Burris has no other line
        CHECK_THAT(error.what(), ContainsSubstring("no reading") &&
                                     ContainsSubstring(fmt::format(":{}: {}", line, reason)));
        return;
    }
    CHECK(file.readings.size() == 1);
    REQUIRE_FALSE(file.refused.empty());
    CHECK(file.refused[0].line == line);
    CHECK_THAT(file.refused[0].reason, ContainsSubstring(reason));
}

TEST_CASE("a CG-5 without a line of names is known to begin with coordinates by its header") {
    const std::string reading = cg5_reading("1", "10:00:00");
    const auto at = [&](std::string line, const std::string& one, const std::string& two) {
        return line.replace(0, line.find(" 12.5"), one + " " + two);
    };
    const std::string header = cg5_header("0.0"), note = "/\tNote:   \tB-7 46.5 46.2\r\n";
    const auto by_note = read(header + note + at(reading, "-33.2", "-70.6"));
    CHECK(by_note.readings.front().site == "B-7");
    CHECK(by_note.readings.front().position->longitude == Degrees(-70.6));
    CHECK(read(header + note + at(reading, "0.0", "2.0000000")).readings.front().site == "2");
    CHECK(read(header + note + at(reading, "-33.0000000", "-70.0000000")).readings.front().site ==
          "-70");
    const auto without_note = read(header + at(reading, "0.0", "3.5000000"));
    CHECK(without_note.readings.front().site == "3.5");
    CHECK_THROWS_WITH(read(header + at(reading, "-33.2", "-70.6")),
                      ContainsSubstring("no header with Note, whose first word is the station"));
}

TEST_CASE("a CG-5 with stations in the notes lists them, and a file lists all its layouts") {
    const std::string line = cg5_reading("1", "10:00:00"), header = cg5_header("0.0");
    std::string at = line;
    at.replace(0, at.find(" 12.5"), "-33.2 -70.6");
    const std::string by_note =
        header + "/\tNote: A 1\r\n" + at + "/\tNote: wind\r\n" + at + at + "/\tNote: A 1\r\n" + at;
    const std::string found =
        "15 columns in the usual order, without a line of names, LAT and LONG known from the "
        "header, station from the first word of the line Note:";
    const std::string list = "; stations from notes: A, wind";
    CHECK(read(by_note).layout == found + list);
    const std::string usual = "15 columns in the usual order, without a line of names";
    CHECK(read(header + line + by_note + header + line).layout == usual + "; " + found + list);
    CHECK(read(by_note + header + line).layout == found + "; " + usual + list);
}

TEST_CASE("a CG-5 can have its options before the survey, and lines switched off") {
    const std::string options = "/\tTide Correction:    YES\r\n";
    const std::string header = changed(cg5_header("0.0"), options, "");
    const auto file =
        read(options + "#" + cg5_reading("1", "10:00:00") + header + cg5_reading("1", "10:00:00"));
    CHECK(file.readings.size() == 1);
    CHECK(file.refused.empty());
    CHECK_THAT(read(options + header + cg5_reading("1", "10:00:00") + header +
                    cg5_reading("1", "10:01:00"))
                   .refused.front()
                   .reason,
               ContainsSubstring("no header with Tide Correction"));
}

TEST_CASE("a CG-6 keeps a reading whose standard deviation is too wide for its column") {
    const std::string line = cg6_reading("A", "10:00:00");
    const auto file = read(cg6_header() + changed(line, "0.0128", "****"));
    REQUIRE(file.readings.size() == 1);
    CHECK(kept(file.readings[0], "sd_mgal").empty());
    CHECK_THAT(read(cg6_header() + changed(line, "0.0128", "0.x1") + cg6_reading("A", "10:01:00"))
                   .refused.front()
                   .reason,
               ContainsSubstring("StdDev = 0.x1: not a number"));
}

TEST_CASE("a reading ends the names of an export for Tsoft, so that the next station is known") {
    const std::string line = "2017 7 24 0 9 36 1578.474 -0.0374\n";
    const auto file = read(
        "/ CG-6 Gravity Survey\n/ Meter: 007\n/ Tidal Correction: Enabled\n/ Station: s1\n"
        "/ Column Headers:\n/ Year\n/ Month\n/ DayOfMonth\n/ Hour\n/ Minute\n/ Second\n"
        "/ CorrGravity(mGals)\n/ TidalCorr(mGals)\n" +
        line + "/ Station: s2\n" + line);
    REQUIRE(file.readings.size() == 2);
    CHECK(file.readings[1].site == "s2");
}

TEST_CASE("a CG-6 export for Tsoft has its station in the header, and is read by name") {
    const std::string header =
        "/ CG-6 Gravity Survey\n/ Software Version: 1.2\n/ Meter: 007\n/ Tidal Correction: "
        "Disabled\n/ Station: s 1\n/ Occupation: 4\n/ \n/ Column Headers:\n/ Year\n/ Month\n"
        "/ DayOfMonth\n/ Hour\n/ Minute\n/ Second\n/ MilliSec\n/ CorrGravity(mGals)\n"
        "/ TidalCorr(mGals)\n/ InstHeight(cm)\n/ \n";
    const auto file = read(header + "2017  7 24  0  9 36 250 1578.474 -0.0374 21.5\n" +
                           "/ Software Version: 1.2\n/ Station: s2\n" +
                           "2017  2 30  0 19 36 250 1578.474 -0.0374 21.5\n" +
                           "2017  7 24  0 19 36 250 1578.474 -0.0374 21.5\n");
    CHECK(file.layout == "export for Tsoft, 10 columns, by name");
    REQUIRE(file.readings.size() == 2);
    CHECK(file.readings[0].instrument == "CG-6 007");
    CHECK(file.readings[0].site == "s 1");
    CHECK(file.readings[1].site == "s2");
    CHECK(to_rfc3339(file.readings[0].time, 3) == "2017-07-24T00:09:36.250Z");
    CHECK_FALSE(file.readings[0].tide_correction.has_value());
    CHECK(file.readings[0].height->value() == Approx(0.215));
    CHECK(kept(file.readings[0], "stay_number") == "4");
    REQUIRE(file.refused.size() == 1);
    CHECK_THAT(file.refused[0].reason, ContainsSubstring("Year to MilliSec: not an instant"));
}

TEST_CASE("a GCYM table is read in the zone that is given, and marks its loops") {
    const test::TemporaryDirectory folder;
    const auto path =
        folder.write("q",
                     "   ai   CAR\n  C098 GCYM 1508211134 13064422 4424.250 1000.0 29.0\n44444\n"
                     "  C098 GCYM 1508211246 13064524 4434.741 1000.0 30.0\n55555\n"
                     "  C098 GCYM 1508211346 13064524 4434.741 1000.0 30.0\n"
                     "  C098 GCYM 1513211346 13064524 4434.741 1000.0 30.0\n99999");
    CHECK_THROWS_WITH(read_gravimeter_file(path), ContainsSubstring("allowed: --zone +hh:mm"));
    std::vector<GravimeterFile> files{read_gravimeter_file(path, {std::chrono::hours(8)})};
    CHECK_THAT(files[0].layout, ContainsSubstring("times in the zone +08:00"));
    REQUIRE(files[0].readings.size() == 3);
    CHECK(to_rfc3339(files[0].readings[0].time) == "2015-08-21T03:34:00Z");
    CHECK_FALSE(files[0].readings[0].tide_correction.has_value());
    CHECK(kept(files[0].readings[0], "pressure_hpa") == "1000.0");
    REQUIRE(files[0].refused.size() == 1);
    CHECK_THAT(files[0].refused[0].reason, ContainsSubstring("YYMMDDhhmm = 1513211346"));
    const auto stays = find_stays(files);
    REQUIRE(stays.size() == 3);  // the loop ends a stay too
    CHECK(stays[1].loop == 1);
    CHECK(stays[2].loop == 2);
}

TEST_CASE("a torn line of a GCYM table and another network are refused") {
    const test::TemporaryDirectory folder;
    const std::string reading = "C098 GCYM 1508211134 13064422 4424.250 1000.0 29.0\n";
    const auto refused = [&](const std::string& content) {
        return read_gravimeter_file(folder.write("q", content + "99999\n"), {std::chrono::hours(8)})
            .refused;
    };
    CHECK(refused("\nai CAR\n" + reading).empty());
    for (const std::string& content :
         {"ai CAR\n" + reading + "C098 GCYM\n", "C098 GCYM\n" + reading})
        REQUIRE(refused(content).size() == 1);
    CHECK(refused(reading + "C098 GCYM\n")[0].reason == "2 columns; allowed: 7");
    const std::string other = changed(reading, "GCYM", "GCYN");
    REQUIRE(refused(reading + other).size() == 1);
    CHECK(refused(reading + other)[0].reason == "network = GCYN: allowed: GCYM");
}

TEST_CASE("damaged and foreign lines are refused with number and reason, and the others are read") {
    const auto [content, line, reason] = GENERATE(table<std::string, std::size_t, std::string>({
        {cg5_header("0.0") + cg5_reading("1", "10:00:00") + cg5_reading("1", "25:00:00"), 10,
         "TIME = 2013/09/15 25:00:00: not an instant"},
        {cg5_header("0.0") + cg5_reading("1", "10:00:00") + cg5_reading("1", "10:01:00", "20x0"),
         10, "GRAV. = 20x0: not a number; allowed: -20000 to 20000"},
        {cg5_header("0.0") + cg5_reading("1", "10:00:00") + burris_reading("a", "10:00:00"), 10,
         "16 columns; allowed: 15"},
        {cg5_reading("1", "10:00:00") + cg5_header("0.0") + cg5_reading("1", "10:00:00"), 1,
         "no header with Instrument S/N before it"},
        {cg6_header() + cg6_reading("A", "10:00:00") + cg6_reading("A", "10:01:00", "2"), 6,
         "not five digits 0 or 1"},
        {cg6_header() + cg6_reading("A", "10:00:00") + "A\t2017-04-17\n", 6,
         "2 columns; allowed: 22"},
        {burris_reading("a", "10:00:00") + "\x01\xff\n", 2, "1 columns; allowed: 16"},
        {burris_reading("a", "10:00:00") + burris_reading("a", "10:00:10").substr(0, 60), 2,
         "may be cut off"},
    }));
    const auto file = read(content);
    CHECK(file.readings.size() == 1);
    REQUIRE(file.refused.size() == 1);
    CHECK(file.refused[0].line == line);
    CHECK_THAT(file.refused[0].reason, ContainsSubstring(reason));
}

TEST_CASE("a file of no known format, or without a reading, is refused in one line") {
    const auto [content, words] = GENERATE(table<std::string, std::string>({
        {"", "not a file of a gravimeter"},
        {"site,gravity\nA,979800\n", "not a file of a gravimeter"},
        {cg5_header("0.0"), "no reading of a Scintrex CG-5"},
        {cg6_header(), "no reading of a Scintrex CG-6"},
        {"a",
         "allowed: Scintrex CG-5 (of the instrument), Scintrex CG-6 (of the instrument), Scintrex "
         "CG-6 (of Lynx LG, with or without notes, or its export for Tsoft), ZLS Burris (15, 16 or "
         "20 columns), GCYM table"},
        {cg5_reading("1", "10:00:00"), "readings of a Scintrex CG-5 without its header"},
        {"A\t2023-05-04\t09:11:22\t2000.85\t0\t0.01\t0.00\t1983.47\t-5.6\t-0.8\t0.43\t-0.06\t0.00\t"
         "0.05\t17.38\t60\t0.31\t1.3\t103.6\t100.0\t1.4\t103.8\t25.9\t11011\n",
         "readings of a Scintrex CG-6 without its header"},
        {"| SCINTREX V5.2 AUTOGRAV / Field Mode R5.21\n", "a file of a Scintrex CG-3"},
        {"[TSF-file] v01.0\n", "a series for Tsoft"},
        {"BM,LAT,LONG,ALT.,GRAV.,SD.,TILTX,TILTY,TEMP,TIDE,DUR,REJ,TIME,DEC.TIME+DATE,TERRAIN,"
         "DATE\n",
         "a table for GSadjust"},
        {" 1 2639.321 0.009 60 1 0.1 1.8 -2.32 0.040 258 339.000 150913 053922 0 0.0 -0.006 0\n",
         "readings prepared by pyGrav"},
        {"\xFF\xFE/\n", "a text in UTF-16"},
        {"PK\x03\x04\n", "a spreadsheet or an archive"},
        {"Station,Operator,Meter,Date,Time,Grav,Dial\n" + burris_reading("a", "10:00:00"),
         "unknown columns: Station, Operator, Meter, Grav; missing columns: Station ID, Serial "
         "Number, ObsG, Earthtide Correction"},
        {"Micro-g LaCoste g Processing Report\n", "a report of an absolute gravimeter"},
    }));
    try {
        (void)read(content);
        FAIL("it was read");
    } catch (const InputError& error) {
        CHECK_THAT(error.what(), ContainsSubstring(words));
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
    }
}
