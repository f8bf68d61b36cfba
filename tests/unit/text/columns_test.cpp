#include "protocol/text/columns.hpp"

#include "protocol/text/aligned_text.hpp"
#include "tests/support/catch.hpp"

using namespace a351::text;

TEST_CASE("a Japanese letter has two columns on a terminal, and a table is aligned with it") {
    CHECK(columns_of("") == 0);
    CHECK(columns_of("mGal") == 4);
    CHECK(columns_of("±°") == 2);
    CHECK(columns_of("重力 mGal") == 9);
    CHECK(aligned({{"点", "値"}, {"No.10", "1.5"}}) == "点      値\nNo.10  1.5\n");
}
