#include "protocol/text/csv.hpp"

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::text;

TEST_CASE("a table is read by column name, with any kind of line end") {
    const auto table = CsvTable::parse(
        "\xEF\xBB\xBF"
        "a,b\r\n1, x \r\n\r\n2.5,\n",
        "t.csv");
    REQUIRE(table.row_count() == 2);
    CHECK(table.number(0, "a") == 1.0);
    CHECK(table.cell(0, "b") == "x");
    CHECK(table.number(1, "a") == 2.5);
    CHECK_FALSE(table.has_column("c"));
}

TEST_CASE("a blank line of a single column is an empty cell, except at the end") {
    const auto table = CsvTable::parse("\na\n1\n\n3\r\n \t\r\n5\n\n", "t.csv");
    REQUIRE(table.row_count() == 5);
    CHECK(table.number_if_given(1, "a") == std::nullopt);
    CHECK(table.number(2, "a") == 3.0);
    CHECK(table.cell(3, "a").empty());
    CHECK(table.number(4, "a") == 5.0);
    CHECK(CsvTable::parse("a\n1\n  ", "t.csv").row_count() == 1);
    CHECK_THROWS_WITH((void)table.number(1, "a"), StartsWith("t.csv:4: a = : not a number"));
}

TEST_CASE("an error in a CSV file names file, line, column, value and what is allowed") {
    const auto table = CsvTable::parse("a,b\n1,2\n\nnan,3\n400,3\n", "t.csv");
    CHECK_THROWS_WITH(
        (void)table.number(1, "a"),
        "t.csv:4: a = nan: not a number; allowed: a finite number with a decimal point");
    CHECK_THROWS_WITH((void)table.number(2, "a", -180, 360),
                      "t.csv:5: a = 400: out of range; allowed: -180 to 360");
    CHECK_THROWS_WITH((void)table.cell(0, "c"), "t.csv:1: column c is missing; there are: a,b");
    CHECK_THROWS_WITH(CsvTable::parse("a,a\n", "t.csv"),
                      "t.csv:1: column a appears twice; allowed: once");
    CHECK_THROWS_AS(CsvTable::parse("", "t.csv"), InputError);
    CHECK_THROWS_AS(read_csv("/nowhere/t.csv"), InputError);
}

TEST_CASE("a number that a spreadsheet has rounded for its screen is refused") {
    const auto read = [](const std::string& cell) {
        const auto table = CsvTable::parse("g\n" + cell + "\n", "sites.csv");
        return table.unrounded(0, "g", 0.1, 0.0, 1e6);
    };
    CHECK(read("979860.21") == 979860.21);
    CHECK(read("979860") == 979860.0);
    CHECK(read("9.798602E+05") == 979860.2);
    CHECK(read("9798602e-1") == 979860.2);
    CHECK_THROWS_WITH(read("9.7986E+05"),
                      "sites.csv:2: g = 9.7986E+05: rounded by a spreadsheet; allowed: all digits, "
                      "without an exponent");
    CHECK_THROWS_AS(read("9.79860e5"), InputError);
    CHECK_THROWS_AS(read("1e6"), InputError);
}

TEST_CASE("a miniSEED file is named as such, not read as a table") {
    CHECK_THROWS_WITH(
        (void)read_csv(A351_GOLDEN "/miniseed/XX.A351.00.BNZ_steim2_blockette100.mseed"),
        EndsWith("a miniSEED file; allowed: a table (CSV), or miniSEED in the archive of a data "
                 "root with metadata/station.xml"));
    CHECK(CsvTable::parse("000001D,x\n1,2\n", "t.csv").row_count() == 1);
}

TEST_CASE("the shortest text of a number reads back as the same number") {
    CHECK(shortest(0.1) == "0.1");
    CHECK(shortest(-981705.102) == "-981705.102");
    CHECK(shortest(1.0 / 3.0) == "0.3333333333333333");
}
