#include "corrector/gravimeter/stays.hpp"

#include "corrector/gravimeter/survey_tables.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/unit/gravimeter/made_up_lines.hpp"

using namespace a351;
using namespace a351::corrector::gravimeter;
using namespace made_up;

namespace {

std::vector<GravimeterFile> read_files(const std::vector<std::string>& contents) {
    std::vector<GravimeterFile> files;
    for (const std::string& content : contents) files.push_back(read(content));
    return files;
}

std::string table(const std::vector<text::NamedText>& tables, const std::string& name) {
    for (const auto& [key, content] : tables)
        if (key == name) return content;
    return {};
}

}  // namespace

TEST_CASE(
    "a stay ends with the station, a long pause or a new setting of the dial, and the dial "
    "begins a loop") {
    auto files = read_files({burris_reading("a", "10:00:00") + burris_reading("a", "10:01:00") +
                             burris_reading("b", "10:10:00") + burris_reading("b", "11:10:01") +
                             burris_reading("b", "11:11:00", "2850") +
                             burris_reading("a", "11:20:00", "2850")});
    const auto stays = find_stays(files);
    std::string text;
    for (const Stay& stay : stays)
        text += stay.site + std::to_string(stay.occupation) + " loop " + std::to_string(stay.loop) +
                " n " + std::to_string(stay.readings.size()) + "; ";
    CHECK(text == "a1 loop 1 n 2; b1 loop 1 n 1; b2 loop 1 n 1; b3 loop 2 n 1; a2 loop 2 n 1; ");
}

TEST_CASE("a stay ends where the tide correction is switched") {
    auto files = read_files(
        {cg6_header() + cg6_reading("A", "10:00:00") + cg6_reading("A", "10:01:00", "11001")});
    CHECK(find_stays(files).size() == 2);
}

TEST_CASE("several instruments have stays of their own, numbered together at each site") {
    auto files = read_files({burris_reading("a", "10:00:00") + burris_reading("b", "10:20:00"),
                             burris_reading("a", "10:10:00", "2750", ' ', "B108") +
                                 burris_reading("a", "10:11:00", "2750", ' ', "B108")});
    const auto stays = find_stays(files);
    REQUIRE(stays.size() == 3);
    CHECK(stays[1].instrument == "B108");
    CHECK(stays[1].occupation == 2);
    CHECK(stays[1].loop == 1);
    CHECK(stays[2].site == "b");
}

TEST_CASE("a reading that is given twice is refused once") {
    const std::string line = burris_reading("a", "10:00:00");
    auto files = read_files({line + burris_reading("a", "10:00:10"), line});
    const auto stays = find_stays(files);
    CHECK(stays.front().readings.size() == 2);
    REQUIRE(files[1].refused.size() == 1);
    CHECK(files[1].refused[0].line == 1);
    CHECK(survey_tables(files, stays, {}).size() == 3);  // the second file has no reading left
}

TEST_CASE("the average of a stay is of its last readings, as median or mean") {
    std::string content = cg5_header("0.0");
    for (const auto& [time, value] : {std::pair("10:00:00", "2009.0"),
                                      {"10:01:00", "2000.0"},
                                      {"10:02:00", "2001.0"},
                                      {"10:03:00", "2002.0"},
                                      {"10:04:00", "2004.0"}})
        content += cg5_reading("1", time, value);
    auto files = read_files({content});
    const auto stays = find_stays(files);
    CHECK(average_of(stays[0], {4, false}).value == MilliGal(2001.5));
    CHECK(average_of(stays[0], {4, true}).value == MilliGal(2001.75));
    CHECK(average_of(stays[0], {0, true}).value == MilliGal(2003.2));
    CHECK(average_of(stays[0], {99, false}).count == 5);
    CHECK(to_rfc3339(average_of(stays[0], {4, false}).time) == "2013-09-15T10:02:30Z");
    CHECK(average_of(stays[0], {2, false}).sd->value() == Approx(std::sqrt(2.0)));
}

TEST_CASE("the tide of the instrument is kept as its effect on gravity, or taken out") {
    auto files = read_files({burris_reading("a", "10:00:00")});
    const auto stays = find_stays(files);
    const std::string kept = table(survey_tables(files, stays, {}), "observations.csv");
    CHECK_THAT(kept,
               ContainsSubstring("a,1,0,2017-12-05T10:00:00Z,0.10300,2769.79800,,B44,1,0.1,,,1"));
    const std::string removed = table(survey_tables(files, stays, {{}, false}), "observations.csv");
    CHECK_THAT(removed, ContainsSubstring("a,1,0,2017-12-05T10:00:00Z,2769.79800,,B44,1,0.1,,,1"));
    CHECK_THAT(removed, !ContainsSubstring("earth_tide_mgal"));
}

TEST_CASE("a tide system leaves its part of the permanent tide in gravity, and is named") {
    TableOptions options;
    options.tide_system = corrector::tide::System::mean;
    auto files = read_files({burris_reading("a", "10:00:00")});
    const std::string mean =
        table(survey_tables(files, find_stays(files), options), "observations.csv");
    CHECK_THAT(mean, ContainsSubstring(",sd_mgal,readings,tide_system\n"));
    CHECK_THAT(mean, ContainsSubstring("a,1,0,2017-12-05T10:00:00Z,0.10344,2769.79800,,B44,1,0.1,,"
                                       ",1,mean\n"));

    files[0].readings[0].position.reset();
    CHECK_THROWS_WITH(survey_tables(files, find_stays(files), options),
                      ContainsSubstring("--tide-system = mean: a has no position in the files"));
}

TEST_CASE("a tide that the instrument did not remove cannot be kept") {
    auto files = read_files({cg5_header("0.0", "NO") + cg5_reading("1", "10:00:00")});
    const auto stays = find_stays(files);
    CHECK_THROWS_AS(survey_tables(files, stays, {}), InputError);
    CHECK_THAT(table(survey_tables(files, stays, {{}, false}), "observations.csv"),
               ContainsSubstring(",2000.00000,,CG-5 123,1,"));
}

TEST_CASE("text of the operator cannot break the table of readings") {
    auto files =
        read_files({changed(cg6_header() + cg6_reading("A", "10:00:00"), "\t1\t", "\tx,\x01yÄ\t")});
    const auto stays = find_stays(files);
    CHECK_THAT(table(survey_tables(files, stays, {}), "readings.csv"),
               ContainsSubstring(",x;?yÄ,"));
}
