#include "corrector/figure/escaping.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::figure;

TEST_CASE("valid UTF-8 is kept, other bytes and control characters become U+FFFD") {
    CHECK(clean_utf8("No.5 \u7B51\u6CE2 \u00B0 \U0001F600") ==
          "No.5 \u7B51\u6CE2 \u00B0 \U0001F600");
    CHECK(clean_utf8("a\nb\x7F") == "a\uFFFDb\uFFFD");
    CHECK(clean_utf8(std::string_view("\0", 1)) == "\uFFFD");
    CHECK(clean_utf8("\xC2\x85") == "\uFFFD\uFFFD");                      // U+0085, a control
    CHECK(clean_utf8("\xE9t\xE9") == "\uFFFDt\uFFFD");                    // Latin-1
    CHECK(clean_utf8("\xC0\xAF") == "\uFFFD\uFFFD");                      // overlong '/'
    CHECK(clean_utf8("\xED\xA0\x80") == "\uFFFD\uFFFD\uFFFD");            // surrogate
    CHECK(clean_utf8("\xEF\xBF\xBE") == "\uFFFD\uFFFD\uFFFD");            // U+FFFE, not in XML
    CHECK(clean_utf8("\xF4\x90\x80\x80") == "\uFFFD\uFFFD\uFFFD\uFFFD");  // beyond U+10FFFF
    CHECK(clean_utf8("ab\xE7\xAD") == "ab\uFFFD\uFFFD");                  // cut off
}

TEST_CASE("a long label is cut between characters") {
    CHECK(short_label("12345678901234567890") == "12345678901234567890");
    CHECK(short_label("\u7B51345678901234567890AB") == "\u7B51345678901234567890\u2026");
    CHECK(short_label("\xFF") == "\uFFFD");
}

TEST_CASE("text in a gnuplot string cannot end it") {
    CHECK(gnuplot_string("It's `ls` \\n @x\n") == "'It\u2019s `ls` \\n @x\uFFFD'");
}
