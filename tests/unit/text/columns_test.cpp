#include "protocol/text/columns.hpp"

#include "protocol/text/aligned_text.hpp"
#include "tests/support/catch.hpp"

using namespace a351::text;

TEST_CASE("a Japanese letter has two columns on a terminal, another one has one", "[text]") {
    CHECK(columns_of("") == 0);
    CHECK(columns_of("mGal") == 4);
    CHECK(columns_of("±°") == 2);
    CHECK(columns_of("重力 mGal") == 9);
}

TEST_CASE("columns of a table are aligned whatever letters it has", "[text]") {
    CHECK(aligned({{"点", "値"}, {"No.10", "1.5"}}) == "点      値\nNo.10  1.5\n");
}
