#include "protocol/text/strict_toml.hpp"

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/toml_without.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::text;

TEST_CASE("every key that is read is allowed, and missing keys get their defaults") {
    auto root = parse_toml(
        "name = \"x\"\nflag = true\ncount = 3\nlist = [1, 2.5]\nnames = [\"a\"]\npath = \"d/f\"\n"
        "[sub]\nrate = 50\n[[item]]\nn = 1\n[[item]]\nn = 2\n",
        "dir/c.toml");
    CHECK(root.string_or("name", "y") == "x");
    CHECK(root.string_or("other", "y") == "y");
    CHECK(root.boolean_or("flag", false));
    CHECK(root.integer_or("count", 0, 1, 9) == 3);
    CHECK(root.numbers("list", 0, 10) == std::vector<double>{1.0, 2.5});
    CHECK(root.strings("names") == std::vector<std::string>{"a"});
    CHECK(root.path_or_empty("path") == "dir/d/f");
    CHECK(root.path_or_empty("no_path").empty());
    auto sub = root.table("sub");
    CHECK(sub.number_or("rate", 0, 0, 100) == 50.0);
    sub.require_all_read();
    auto items = root.tables("item");
    REQUIRE(items.size() == 2);
    CHECK(items[1].integer_or("n", 0, 0, 9) == 2);
    CHECK_NOTHROW(root.require_all_read());
    CHECK(root.table("absent").number("x", 0, 1) == std::nullopt);
}

TEST_CASE("an error in a TOML file is one line, whatever the file contains") {
    CHECK_THROWS_WITH(parse_toml("a = t\n", "c.toml"),
                      "c.toml:1: not TOML: Error while parsing boolean: expected 'true', saw "
                      "'t '; the line begins a ; allowed: key = value, with texts in quotes");
    auto root = parse_toml(R"("two\nlines" = "red\u001b[31m")", "c.toml");
    CHECK_THROWS_WITH(root.require_all_read(),
                      "c.toml:1: two\\x0Alines = \"red\\u001B[31m\": unknown key; allowed: ");
}

TEST_CASE("an error in a TOML file names file, line, key, value and what is allowed") {
    auto root = parse_toml("a = 1\n[s]\nb = \"x\"\nc = 70.1\n", "c.toml");
    auto sub = root.table("s");
    CHECK_THROWS_WITH(sub.integer_or("b", 0, 0, 9),
                      "c.toml:3: s.b = 'x': wrong type; allowed: a whole number from 0 to 9");
    CHECK_THROWS_WITH(sub.number_or("c", 0, 0, 60),
                      "c.toml:4: s.c = 70.1: out of range; allowed: a number from 0 to 60");
    CHECK_THROWS_WITH(sub.choice_or("b", "y", {"y", "z"}),
                      "c.toml:3: s.b = 'x': not a known value; allowed: y, z");
    CHECK_THROWS_WITH(root.require_all_read(), "c.toml:1: a = 1: unknown key; allowed: s");
    CHECK_THROWS_WITH(parse_toml("a = \n", "c.toml"), StartsWith("c.toml:1: not TOML: "));
    CHECK_THROWS_AS(read_toml("/nowhere/c.toml"), InputError);
}

TEST_CASE("a misspelt key is named with the right one") {
    auto station = parse_toml("[station]\nlattitude = 36.1\nlongitude = 140\n", "c.toml");
    auto table = station.table("station");
    CHECK_THROWS_WITH(table.refuse("latitude", "missing", "a number"),
                      "c.toml:2: station.lattitude: unknown key; did you mean latitude?");
    CHECK(table.number("longitude", -180, 360) == 140.0);
    CHECK(table.number("latitude", -90, 90) == std::nullopt);
    CHECK_THROWS_WITH(table.require_all_read(),
                      "c.toml:2: station.lattitude: unknown key; did you mean latitude?");
    auto other = parse_toml("root = 1\n", "c.toml");
    CHECK(other.string_or("port", "") == "");
    CHECK_THROWS_WITH(other.require_all_read(), "c.toml:1: root = 1: unknown key; allowed: port");
}

TEST_CASE("a text written as a TOML string is read back") {
    for (const std::string text :
         {"No.5", "a \"b\" \\ c", "tab\tline\nbell\x07 del\x7f", "\xc3\xa9 \xe5\xb1\xb1"}) {
        CAPTURE(text);
        auto root = parse_toml("key = " + toml_string(text) + "\n", "made up");
        CHECK(root.string_or("key", "") == text);
    }
}

TEST_CASE("a document is shown without a secret, however it is written") {
    const test::TemporaryDirectory folder;
    for (const char* page : {"[page]\ntoken = \"SECRET\" # was SECRET\nlisten = \"a:1\"\n",
                             "page.listen = \"a:1\"\npage.token = \"\"\"\nSECRET\"\"\"\n",
                             "page = { token = 'SECRET', listen = \"a:1\" }\n"}) {
        const auto file = folder.write("a351d.toml", page);
        CHECK(toml_without(file, "page", "token").find("SECRET") == std::string::npos);
        const auto shown = folder.write("shown.toml", toml_without(file, "page", "token"));
        CHECK(read_toml(shown).table("page").string_or("listen", "") == "a:1");
    }
    CHECK(toml_without(folder.write("a351d.toml", "a = 1\n"), "page", "token") == "a = 1\n");
}
