#include "corrector/gravimeter/site_names.hpp"

#include "corrector/gravimeter/survey_tables.hpp"
#include "protocol/text/sites.hpp"
#include "tests/unit/gravimeter/made_up_lines.hpp"

using namespace a351;
using namespace a351::corrector::gravimeter;
using namespace made_up;

namespace {

std::vector<GravimeterFile> files_with(const std::vector<std::string>& names) {
    std::string content = cg6_header();
    for (std::size_t i = 0; i < names.size(); ++i)
        content += cg6_reading(names[i], "10:0" + std::to_string(i) + ":00");
    return {read(content)};
}

}  // namespace

TEST_CASE("names with a comma, a sign, blanks or in another script survive the tables") {
    auto files = files_with({"A, north", "-5", "A 1", "測点 1", "\"B\"", "Ост-3"});
    CHECK(files[0].refused.empty());
    const auto remarks = text::in_english(make_table_names(files));
    CHECK(remarks ==
          std::vector<std::string>{
              "the station A, north is A; north in the tables, because they cannot have its name",
              "the station -5 is _-5 in the tables, because they cannot have its name",
              "the station \"B\" is 'B' in the tables, because they cannot have its name"});
    const auto stays = find_stays(files);
    for (const auto& [name, content] : survey_tables(files, stays, {})) {
        if (name != "sites.csv") continue;
        const auto sites = text::parse_sites(content, name);
        REQUIRE(sites.size() == 6);
        for (const std::string site : {"A; north", "_-5", "A 1", "測点 1", "'B'", "Ост-3"})
            CHECK(text::find_site(sites, site) != nullptr);
    }
}

TEST_CASE("two names that would be one in the tables are refused") {
    auto files = files_with({"A,1", "A;1"});
    CHECK_THROWS_WITH(
        make_table_names(files),
        ContainsSubstring("no-name:6: station = A;1: would be A;1 in the tables, as A,1 is"));
}

TEST_CASE("names that differ only in writing are asked about and remain two stations") {
    auto files = files_with({"No.1", "no.1", "0016", "16", "16", "17"});
    const auto remarks = text::in_english(make_table_names(files));
    REQUIRE(remarks.size() == 2);
    CHECK(remarks[0] ==
          "the names 0016 and 16 differ only in capitals, blanks or zeros. They are two stations "
          "here, with 1 and 2 readings: if they are one, use one name in the files");
    CHECK_THAT(remarks[1], ContainsSubstring("the names No.1 and no.1"));
    CHECK(find_stays(files).size() == 5);
}

TEST_CASE("a file with a byte-order mark is read") {
    const std::string mark = "\xEF\xBB\xBF";
    CHECK(read(mark + cg6_header() + cg6_reading("A", "10:00:00")).readings.size() == 1);
    CHECK(read(mark + burris_reading("A", "10:00:00")).readings.front().site == "A");
}
