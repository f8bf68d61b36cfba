#include "protocol/text/echo.hpp"

#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"

using namespace a351::text;

TEST_CASE("what an error line echoes is visible and short", "[text]") {
    CHECK(echoed("No.0 \xC3\xA9") == "No.0 \xC3\xA9");
    CHECK(echoed("a\x1B[31m\xFF\xC2\x85") == "a\\x1B[31m\\xFF\\xC2\\x85");
    CHECK(echoed(std::string(100, 'a')) == std::string(100, 'a'));
    CHECK(echoed(std::string(70'000, 'a')) == std::string(100, 'a') + "... (70000 bytes)");
    const CsvTable table = CsvTable::parse("a\n" + std::string(70'000, '7') + "x\n", "t.csv");
    CHECK_THROWS_WITH(table.number(0, "a", 0.0, 1.0),
                      "t.csv:2: a = " + std::string(100, '7') +
                          "... (70001 bytes): not a number; allowed: a finite number with a "
                          "decimal point");
}
