/// @file
/// Forms in which spreadsheets save a table, after public reports of people who met them:
/// ruuvi #1156, MoBi #210, geoda #123, jamovi #437, hydroserverlite #57, OpenRCT2 #1791.

#include "tests/support/catch.hpp"

#include <sstream>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/plain_text.hpp"
#include "protocol/text/sites.hpp"

using namespace a351;
using namespace a351::text;

namespace {

const std::string kRemedy =
    "; in a spreadsheet: set the decimal sign to a point, and save as CSV UTF-8, separated by "
    "commas";

CsvTable parsed(std::string_view text) { return CsvTable::parse(text, "t.csv"); }

/// Returns ASCII as UTF-16 with its byte-order mark.
std::string utf16(std::string_view text, bool is_little) {
    std::string bytes = is_little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char c : text) {
        if (!is_little) bytes += '\0';
        bytes += c;
        if (is_little) bytes += '\0';
    }
    return bytes;
}

}  // namespace

TEST_CASE("each form of a table that can be read in one way is the same table") {
    const std::string plain = "site,latitude_deg,altitude_m,note\nA,36.2,1234,x\nB,-36.25,30,\n";
    const std::string tabs =
        "site\tlatitude_deg\taltitude_m\tnote\r\nA\t36,2\t1234\tx\r\nB\t-36,25\t30\t\r\n";
    for (const std::string& form :
         {plain, tabs, utf16(plain, false), utf16(tabs, true),
          std::string("\"site\",\"latitude_deg\",\"altitude_m\",\"note\"\n\"A\",\"36.2\",\"1234\","
                      "\"x\"\n\"B\",\"-36.25\",30,\"\"\n"),
          std::string("site,latitude_deg,altitude_m,note\nA,\"36,2\",1234,x\nB,\"-36,25\",30,\n"),
          std::string("sep=;\nsite;latitude_deg;altitude_m;note\nA;36,2;1234;x\nB;-36,25;30;\n"),
          std::string("site;latitude_deg;altitude_m;note\nA;36.2;1234;x\nB;-36.25;30;\n"),
          std::string(
              "site,latitude_deg,altitude_m,note,,\nA,36.2,1234,x,,\n,,,,,\nB,-36.25,30,,,\n"
              ",,,,,\n"),
          std::string("site,latitude_deg,altitude_m,note\nA\u00A0,36.2\u3000,\u00A01234,x\n"
                      "\uFF22,\u2212\uFF13\uFF16\uFF0E\uFF12\uFF15,\uFF13\uFF10,\u202F\n")}) {
        CAPTURE(form);
        const CsvTable table = parsed(form);
        REQUIRE(table.row_count() == 2);
        CHECK(table.cell(0, "site") == "A");
        CHECK(table.cell(1, "site") == "B");
        CHECK(table.number(0, "latitude_deg") == 36.2);
        CHECK(table.number(1, "latitude_deg") == -36.25);
        CHECK(table.number(0, "altitude_m") == 1234);
        CHECK(table.number(1, "altitude_m") == 30);
        CHECK(table.cell(0, "note") == "x");
        CHECK(table.cell(1, "note").empty());
    }
}

TEST_CASE("cells in quotation marks hold separators, line breaks and doubled marks") {
    const auto table =
        parsed("site,note\nA,\"after rain, wet; 5\"\" pipe\nand mud\"\nB, \"x\" \nC,5\" pipe\n");
    REQUIRE(table.row_count() == 3);
    CHECK(table.cell(0, "site") == "A");
    CHECK(table.cell(0, "note") == "after rain, wet; 5\" pipe\nand mud");
    CHECK(table.cell(1, "note") == "x");
    CHECK(table.cell(2, "note") == "5\" pipe");
    CHECK_THROWS_WITH((void)table.number(1, "note"), StartsWith("t.csv:4: note = x: "));
}

TEST_CASE("a table that can be read in two ways or none is refused with what to press") {
    for (const auto& [text, trouble] : std::initializer_list<std::pair<std::string, std::string>>{
             {"site,latitude_deg;note\n",
              "1: the header has commas and semicolons; allowed: one of them"},
             {"site,note\rA,1\rB,2\r", "1: lines end in CR alone; allowed: LF or CRLF"},
             {{"s\0,\0t\0\n\0", 8}, "1: UTF-16 without its mark, or no text; allowed: UTF-8"},
             {{"\xFF\xFE\x00\xDC\n\x00", 6}, "1: not valid UTF-16; allowed: UTF-8"},
             {"sep=|\na|b\n", "1: cells separated by |; allowed: , ; or a tab"},
             {"a,b\n1,\"2\n", "2: a quotation mark that none closes; allowed: pairs"},
             {"a,b\n1,\"2\"3\n", "2: text behind a closing quotation mark; allowed: a separator"},
             {"\"site,latitude_deg\"\n\"A,36.2\"\n",
              "1: the whole line is one cell in quotation marks; allowed: a cell for each column"}})
        CHECK_THROWS_WITH(parsed(text), "t.csv:" + trouble + kRemedy);
    CHECK_THROWS_WITH(
        parsed("site,latitude_deg\nA,36,2\n"),
        "t.csv:2: 3 cells; allowed: 2 as in the header; a comma outside quotation marks always "
        "separates, and a number has a point");
    CHECK_THROWS_WITH(parsed("site,latitude_deg\nA\n"),
                      "t.csv:2: 1 cells; allowed: 2 as in the header");
}

TEST_CASE(
    "a comma that may stand between thousands is refused unless other numbers show the sign") {
    CHECK_THROWS_WITH(
        parsed("site;latitude_deg;altitude_m\nA;36.2;30\nB;36.2;1,234\n"),
        "t.csv:3: altitude_m = 1,234: other numbers of this table have a decimal point; allowed: "
        "one sign in a table" +
            kRemedy);
    CHECK_THROWS_WITH(parsed("a_m;b_m\n36,2;1.234\n"),
                      StartsWith("t.csv:2: b_m = 1.234: other numbers of this table have a decimal "
                                 "comma"));
    for (const char* text :
         {"a\tb\n1\t1,234\n", "a,b\n1,\"1,234\"\n", "a;b\n1;1,234\n", "a;b\n-12,345;-1,234\n",
          "a;b\n1;1.234,5\n", "a\tb\n1\t979,951.2\n", "a\tb\n1\t1 234,5\n"}) {
        CAPTURE(text);
        const auto table = parsed(text);
        CHECK_THROWS_WITH((void)table.number(0, "b"), EndsWith(kRemedy));
    }
    // Another number shows the sign, or thousands do not begin with 0.
    CHECK(parsed("a_m;b\n1,5;1,234\n").number(0, "b") == 1.234);
    CHECK(parsed("a_m\tb\n1\t1,234\n1,5\t2\n").number(0, "b") == 1.234);
    CHECK(parsed("a_m;b\n-0,123;1,234\n").number(0, "b") == 1.234);
    // A point is between thousands only where a comma is the decimal sign.
    CHECK(parsed("a;b\n1;1.234\n").number(0, "b") == 1.234);
}

TEST_CASE("only columns that are named with a unit show the decimal sign of a table") {
    CHECK(parsed("site;b_m\n12.5;1,5\n").number(0, "b_m") == 1.5);
    CHECK(parsed("version;b_m\n1.5;36,2\n").number(0, "b_m") == 36.2);
    const auto table = parsed("wells;b_m\n5,5;1,234\n");
    CHECK_THROWS_WITH((void)table.number(0, "b_m"), EndsWith(kRemedy));
    std::istringstream in("a;b\n1,5;2\n1.5;2\n");
    CsvReader reader(in, "t.csv");
    reader.expect_numbers(0);
    CHECK(reader.next());
    CHECK_THROWS_WITH(reader.next(), StartsWith("t.csv:3: a = 1.5: other numbers"));
}

TEST_CASE("an empty row within a record is a missing sample, at its end it is nothing") {
    std::istringstream in("a,b\n1,2\n,\n,\n3,4\n,\n");
    CsvReader reader(in, "t.csv");
    std::string rows;
    while (reader.next())
        rows += std::string(reader.cells()[0]) + "@" + std::to_string(reader.line()) + " ";
    CHECK(rows == "1@2 @3 @4 3@5 ");
}

TEST_CASE("names that differ only in the form of their characters are the same") {
    const auto sites = parse_sites(
        "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
        "Cafe\u0301\u00A01,140,36,0,\nNo.\uFF15,140,36,0,\n\u304B\u3099\u3051,140,36,0,\n",
        "s.csv");
    CHECK(sites[0].name == "Caf\u00E9 1");
    CHECK(find_site(sites, "Cafe\u0301 1") == &sites[0]);
    CHECK(find_site(sites, "No.5") == &sites[1]);
    CHECK(find_site(sites, "No\uFF0E5") == &sites[1]);
    CHECK(find_site(sites, "\u304C\u3051") == &sites[2]);
    CHECK_THROWS_WITH(parse_sites("site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                                  "\u00E9,140,36,0,\ne\u0301,140,36,0,\n",
                                  "s.csv"),
                      StartsWith("s.csv:3: site = \u00E9: appears twice"));
}

TEST_CASE("plain text changes nothing but accents, blanks and widths") {
    CHECK(plain_text("A\u200B1") == "A\u200B1");
    CHECK(plain_text("x\u00B2 \u2460 \u30AB \u212B") == "x\u00B2 \u2460 \u30AB \u00C5");
    CHECK(plain_text("\xE9 in Latin-1") == "\xE9 in Latin-1");
}
