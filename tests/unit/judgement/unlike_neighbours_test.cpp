#include "corrector/judgement/unlike_neighbours.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace a351;
using namespace a351::corrector;

namespace {

/// Six stations up to 1000 m, 1 km apart.  By hand: 980000 mGal at sea level, and 0.197 mGal less for
/// each metre.  H is in the list, was not visited, and is as high as 610 m.
struct Survey {
    model::SurveyCorrection result;
    std::vector<text::Site> sites;

    Survey() {
        for (int i = 0; i < 6; ++i) add(std::string(1, static_cast<char>('A' + i)), 200.0 * i);
        sites.push_back(place("H", 610.0));
    }
    [[nodiscard]] text::Site place(const std::string& name, double height_m) const {
        return {name, Degrees(140.0 + 0.01 * static_cast<double>(sites.size())), Degrees(36.0),
                Metres(height_m), std::nullopt};
    }
    void add(const std::string& name, double height_m) {
        sites.push_back(place(name, height_m));
        model::StationValue& station = result.stations.emplace_back();
        station.site = name;
        station.gravity = MilliGal(980000.0 - 0.197 * height_m);
        station.u_gravity = MilliGal(2.0);
        model::CorrectedRow& row = result.rows.emplace_back();
        row.row.site = name;
        row.row.listed = {name, 1, 1};
    }
    [[nodiscard]] std::vector<reading::Finding> findings() const {
        return judgement::unlike_neighbours(result, sites);
    }
};

}  // namespace

TEST_CASE("a measured gravity that does not fit the height of its station is named") {
    Survey survey;
    CHECK(survey.findings().empty());
    // B, at 200 m, was called but H, at 610 m, was read.
    survey.result.stations[1].gravity = MilliGal(980000.0 - 0.197 * 610.0);
    const auto found = survey.findings();
    REQUIRE(found.size() == 1);
    CHECK(found[0].text.english() ==
          "B (1) is -81 mGal from what its height suggests beside its neighbours: check its name, "
          "position and height, if it is no summit or mine; it would fit H");
    CHECK(found[0].amendment ==
          "[[rename]]\nsite = \"B\"\noccupation = 1\nto = \"H\"\nreason = \"its height fits\"\n");
    SECTION("a second stay is renamed too") {
        survey.result.rows.push_back(survey.result.rows[1]);
        survey.result.rows.back().row.occupation = 2;
        survey.result.rows.back().row.listed = {"B", 2, 1};
        CHECK(survey.findings()[0].amendment.find("occupation = 2") != std::string::npos);
    }
    SECTION("a summit") {
        survey.sites[1].altitude = Metres(2600.0);  // 2000 m above the others: 100 mGal
        survey.result.stations[1].gravity = MilliGal(980000.0 - 0.197 * 2600.0 - 90.0);
        CHECK(survey.findings().empty());
        survey.result.stations[1].gravity = MilliGal(980000.0 - 0.197 * 2600.0 - 110.0);
        CHECK(survey.findings().size() == 1);
    }
    SECTION("two sites fit") {
        survey.sites.push_back(survey.place("I", 600.0));
        CHECK(survey.findings()[0].other_site.empty());
    }
    SECTION("its reference judges a known station") {
        survey.result.stations[1].reference = MilliGal(980000.0 - 0.197 * 200.0);
        CHECK(survey.findings().empty());
    }
    SECTION("its uncertainty allows it") {
        survey.result.stations[1].u_gravity = MilliGal(11.0);
        CHECK(survey.findings().empty());
    }
    SECTION("too few neighbours") {
        for (std::size_t i = 4; i < 6; ++i) survey.sites[i].has_altitude = false;
        CHECK(survey.findings().empty());
    }
    SECTION("the neighbours are far away") {
        for (std::size_t i = 2; i < 6; ++i) survey.sites[i].longitude = Degrees(141.0);
        CHECK(survey.findings().empty());
    }
}

TEST_CASE("no station of the publication is unlike its neighbours, also not the summit") {
    std::vector<text::Site> sites = text::read_sites(A351_GOLDEN "/tsukuba/sites.csv");
    model::SurveyCorrection result;
    for (const text::Site& site : sites) {
        result.stations.emplace_back().site = site.name;
        result.stations.back().gravity = *site.gravity;
        result.rows.emplace_back().row.site = site.name;
    }
    REQUIRE(sites.size() == 14);
    CHECK(judgement::unlike_neighbours(result, sites).empty());
    const auto summit = std::ranges::find(sites, "No.12", &text::Site::name);
    summit->altitude =
        summit->altitude - Metres(150.0);  // 30 mGal less, beside the 24 of its terrain
    const auto found = judgement::unlike_neighbours(result, sites);
    REQUIRE(found.size() == 1);
    CHECK(found[0].site == "No.12");
}
