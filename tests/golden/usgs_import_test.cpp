// Files of three makes of gravimeters: every line and the tide.  tests/golden/usgs/README.md.
#include <fmt/core.h>
#include <cmath>
#include <iostream>
#include "tests/support/catch.hpp"

#include "corrector/gravimeter/contradictions.hpp"
#include "corrector/gravimeter/stays.hpp"
#include "corrector/tide/earth_tide.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::gravimeter;

namespace {

struct Expected {
    std::string file, format, instrument;
    std::size_t readings = 0, comments = 0, stays = 0;
    tide::Model tide = tide::Model::direct;  ///< Tide that the instrument computes.
    tide::Factors factors = {};
    double tide_limit_mgal = 0.003;  ///< Positions are rounded or were moved on purpose.
};
/// A Burris computes Longman's tide.  Its factor was found from these files: with the positions of the
/// absolute gravimeter's reports all 2038 lines agree to the last printed digit, 0.0005 mGal.
constexpr tide::Factors kBurrisFactors{1.2, 1.2};
const std::vector<Expected> kFiles{
    {"B44_2017-12-05.txt", "ZLS Burris", "B44", 708, 0, 86, tide::Model::longman, kBurrisFactors},
    {"B44_2018-02-27.txt", "ZLS Burris", "B44", 794, 0, 76, tide::Model::longman, kBurrisFactors},
    {"B108_2017-12-05.txt", "ZLS Burris", "B108", 536, 0, 52, tide::Model::longman, kBurrisFactors},
    {"cg5_excerpt.txt", "Scintrex CG-5", "CG-5 9379", 64, 36, 5},
    {"CG-6_TestData.dat",
     "Scintrex CG-6",
     "CG-6 000000016050001",
     43,
     20,
     5,
     tide::Model::direct,
     {},
     0.001}};

std::filesystem::path golden(const std::string& file) { return A351_GOLDEN "/usgs/" + file; }

/// Returns the largest difference between an instrument's tide and the computed one, mGal.
/// @param sign  of the effect on gravity in the tide correction.
double tide_difference_mgal(const GravimeterFile& file, const Expected& expected, double sign) {
    double largest = 0.0;
    for (const Reading& reading : file.readings) {
        const tide::Station& at = reading.position.value();
        const MilliGal own =
            tide::earth_tide(expected.tide, reading.time, at, expected.factors);
        const double given = sign * reading.tide_correction.value().value();
        largest = std::max(largest, std::abs(given - own.value()));
    }
    return largest;
}

}  // namespace

TEST_CASE("the files of real instruments contradict themselves nowhere") {
    const auto tide_of = [](UtcTime time, const tide::Station& at) {
        return tide::direct_tide(time, at);
    };
    for (const Expected& expected : kFiles) {
        INFO(expected.file);
        const auto file = read_gravimeter_file(golden(expected.file));
        CHECK(text::in_english(contradictions(file, tide_of)) == std::vector<std::string>());
    }
}

TEST_CASE("every line of the files is a reading or a comment, and none is refused") {
    for (const Expected& expected : kFiles) {
        INFO(expected.file);
        std::vector<GravimeterFile> files{read_gravimeter_file(golden(expected.file))};
        const auto stays = find_stays(files);
        CHECK(files[0].format == expected.format);
        CHECK(files[0].readings.size() == expected.readings);
        CHECK(files[0].comment_count == expected.comments);
        CHECK(files[0].refused.empty());
        CHECK(stays.size() == expected.stays);
        for (const Stay& stay : stays) {
            CHECK(stay.instrument == expected.instrument);
            CHECK(stay.loop == 1);
        }
    }
}

TEST_CASE("the tide of each instrument is the computed one, with the sign of a correction") {
    for (const Expected& expected : kFiles) {
        const GravimeterFile file = read_gravimeter_file(golden(expected.file));
        const double right = tide_difference_mgal(file, expected, -1.0),
                     wrong = tide_difference_mgal(file, expected, 1.0);
        std::cout << fmt::format(
            "{}: tide within {:.4f} mGal, must be within {}; with the wrong sign {:.4f}\n",
            expected.file, right, expected.tide_limit_mgal, wrong);
        CHECK(right <= expected.tide_limit_mgal);
        CHECK(wrong > 10.0 * expected.tide_limit_mgal);
    }
}

TEST_CASE(
    "a file cut at any byte gives the readings before the cut and names the damaged line, or is "
    "refused") {
    const test::TemporaryDirectory folder;
    for (const std::string name : {"cg5_excerpt.txt", "CG-6_TestData.dat", "B44_2017-12-05.txt"}) {
        const std::string whole = text::read_text_file(golden(name));
        const GravimeterFile intact = read_gravimeter_file(golden(name));
        std::size_t refused = 0, read = 0;
        for (std::size_t size = 0; size < std::min<std::size_t>(whole.size(), 9000); ++size) {
            const std::string part = whole.substr(0, size);
            try {
                const GravimeterFile file = read_gravimeter_file(folder.write("cut", part));
                ++read;
                const auto ends = static_cast<std::size_t>(std::ranges::count(part, '\n'));
                const bool is_cut = !part.ends_with('\n');
                REQUIRE(file.refused.size() == (is_cut ? 1 : 0));
                if (is_cut) REQUIRE(file.refused[0].line == ends + 1);
                REQUIRE(file.readings.size() + file.comment_count == ends);
                for (std::size_t i = 0; i < file.readings.size(); ++i) {
                    REQUIRE(file.readings[i].value == intact.readings[i].value);
                    REQUIRE(file.readings[i].time == intact.readings[i].time);
                }
            } catch (const InputError& error) {
                ++refused;
                REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
            }
        }
        std::cout << fmt::format("{}: {} cuts read in part, {} refused\n", name, read, refused);
    }
}
