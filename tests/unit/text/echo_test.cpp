#include "protocol/text/echo.hpp"

#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"

using namespace a351::text;

TEST_CASE("an error line names characters that look like others") {
    CHECK(echoed("No.5\xC2\xA0") == "No.5<U+00A0 no-break blank>");
    CHECK(echoed("\xE2\x80\x8B\xE2\x80\x8B") == "<U+200B invisible><U+200B invisible>");
    CHECK(echoed("\xE2\x88\x92"
                 "12") == "\xE2\x88\x92<U+2212 minus sign, not ->12");
    CHECK(echoed("e\xCC\x81"
                 "e\xCC\x81") == "e\xCC\x81<U+0301 accent apart from its letter>e\xCC\x81");
    // 36.2 in wide digits
    CHECK(echoed("\xEF\xBC\x93\xEF\xBC\x96\xEF\xBC\x8E\xEF\xBC\x92") ==
          "\xEF\xBC\x93<U+FF13 wide>\xEF\xBC\x96\xEF\xBC\x8E\xEF\xBC\x92");
    CHECK(has_hidden_character("a\tb"));
    CHECK(has_hidden_character("a\xC2\xA0"));
    CHECK_FALSE(has_hidden_character("a\xE3\x80\x80"));  // A wide blank is seen.
    CHECK_FALSE(has_hidden_character("\xE6\xB8\xAC\xE7\x82\xB9 1, \xC3\xA9 e\xCC\x81"));
}

TEST_CASE("what an error line echoes is visible and short") {
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
