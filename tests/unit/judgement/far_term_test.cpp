// Where a scale, a step and a reference meet: which of them is named, and with which uncertainty.
#include <fmt/core.h>
#include <cmath>
#include <random>
#include <set>
#include "tests/support/catch.hpp"

#include "corrector/judgement/far_terms.hpp"
#include "corrector/judgement/survey_findings.hpp"

using namespace a351;
using namespace a351::corrector;
using reading::Finding;
using reading::FindingKind;

namespace {

constexpr double kReadingSd_mgal = 0.005;

/// A spring gravimeter on a line: a station, its gravity above the first one and its reference.
struct Place {
    std::string site;
    double gravity_mgal = 0.0;
    bool is_known = false;
};

/// Readings of one meter or several that are carried together, with a drift.
struct Line {
    std::vector<reading::SurveyRow> rows;
    std::mt19937_64 generator{7};

    /// Adds a reading of each meter at a place.
    void visit(const Place& place, double hours, const std::vector<double>& scales) {
        for (std::size_t k = 0; k < scales.size(); ++k) {
            reading::SurveyRow row;
            row.site = place.site;
            row.occupation = 1 + static_cast<int>(std::ranges::count(rows, place.site,
                                                                     &reading::SurveyRow::site));
            row.time =
                parse_rfc3339("2024-06-12T06:00:00Z").value() +
                std::chrono::seconds(std::lround(3600.0 * hours) + 12 * std::ssize(rows) % 72);
            row.instrument = "M" + std::to_string(k);
            row.loop = 1;
            row.has_temperature = false;
            if (place.is_known) {
                row.reference = MilliGal(980000.0 + place.gravity_mgal);
                row.u_reference = MilliGal(0.01);
            }
            // A sum of twelve uniform numbers is normal enough, and the same on every machine.
            double error = -6.0;
            for (int i = 0; i < 12; ++i) error += static_cast<double>(generator() >> 11) * 0x1p-53;
            row.acceleration =
                MilliGal(4000.0 + 100.0 * static_cast<double>(k) + scales[k] * place.gravity_mgal +
                         0.02 * hours + kReadingSd_mgal * error);
            rows.push_back(row);
        }
    }

    /// Adds an offset to all readings of a meter from an hour on.
    void step(std::size_t from, const std::string& meter, double mgal) {
        for (std::size_t i = from; i < rows.size(); ++i)
            if (rows[i].instrument == meter)
                rows[i].acceleration = rows[i].acceleration + MilliGal(mgal);
    }

    /// @param of_first  prior of the scale of M0 alone
    [[nodiscard]] model::SurveyCorrection corrected(
        std::optional<adjustment::Prior> scale = {},
        std::optional<adjustment::Prior> of_first = {}) const {
        model::SurveyOptions options{.model = "network"};
        options.priors.reading_sd_mgal = kReadingSd_mgal;
        if (scale) adjustment::set_prior(options.priors, "test", "scale", *scale);
        if (of_first) adjustment::set_prior(options.priors, "test", "scale M0", *of_first);
        return judgement::correct_and_search({rows, {}, nullptr}, options);
    }
};

const std::vector<Place> kStations{{"A", 0.0, true},
                                   {"B", -151.2, false},
                                   {"C", -60.0, false},
                                   {"D", 35.0, false},
                                   {"E", -97.0, false}};

/// A day out and home, each station twice.
Line day(const std::vector<double>& scales) {
    Line line;
    double hours = 0.0;
    for (const Place& place : kStations) line.visit(place, hours += 0.5, scales);
    for (auto place = kStations.rbegin(); place != kStations.rend(); ++place)
        line.visit(*place, hours += 0.5, scales);
    return line;
}

/// The scale of M0 is off by 8e-4.  The reference of B says, with 0.02 mGal in 151, which of the meters
/// is right.
Line two_meters_of_which_one_is_off() {
    Line two = day({1.0008, 1.0});
    for (reading::SurveyRow& row : two.rows) {
        if (row.site != "A" && row.site != "B") continue;
        row.reference = MilliGal(980000.0 - (row.site == "B" ? 151.2 : 0.0));
        row.u_reference = MilliGal(row.site == "B" ? 0.02 : 0.001);
    }
    return two;
}

std::vector<Finding> mistakes(const model::SurveyCorrection& result) {
    std::vector<Finding> list;
    for (const Finding& finding : result.findings)
        if (!reading::is_remark(finding)) list.push_back(finding);
    return list;
}

}  // namespace

TEST_CASE("meters whose scales differ by more than their prior are named, and no reference is") {
    const Line six = day({1.0007, 1.0004, 1.0001, 0.9999, 0.9996, 0.9993});
    const auto found = mistakes(six.corrected(adjustment::Prior{1.0, 1e-4}));
    REQUIRE(!found.empty());
    std::set<std::string> texts;
    for (const Finding& finding : found) {
        CHECK(finding.kind == FindingKind::scale);
        CHECK(texts.insert(finding.text.english()).second);
    }
    CHECK(mistakes(six.corrected(adjustment::Prior{1.0, 0.001})).empty());
}

TEST_CASE("a scale that another one, which is held, pushes away is named too") {
    const Line two = two_meters_of_which_one_is_off();
    const auto result = two.corrected(adjustment::Prior{1.0, 1e-4});
    const auto found = mistakes(result);
    REQUIRE(found.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
        CHECK(found[k].kind == FindingKind::scale);
        CHECK_THAT(found[k].text.english(), ContainsSubstring(fmt::format("M{}", k)));
    }
    // A prior of one meter concerns this meter only.
    const auto own = two.corrected(adjustment::Prior{1.0, 1e-4}, adjustment::Prior{1.0008, 1e-4});
    CHECK(own.scales.at(0).value == Approx(1.0008).epsilon(0).margin(1e-4));
    CHECK(own.scales.at(1).value == Approx(1.0).epsilon(0).margin(1e-4));
    for (const text::Message& remark : own.remarks)
        CHECK_THAT(remark.english(), !ContainsSubstring("does not use"));
}

TEST_CASE("no further scale is held while a mistake may be what pushes it away") {
    Line two = two_meters_of_which_one_is_off();
    two.step(10, "M1", 0.4);
    const auto found = mistakes(two.corrected(adjustment::Prior{1.0, 1e-4}));
    CHECK(std::ranges::count(found, FindingKind::step, &Finding::kind) == 1);
    CHECK(std::ranges::count(found, FindingKind::scale, &Finding::kind) == 1);
}

TEST_CASE("a step is named with the uncertainty that the scale gives it, and the scale is not") {
    constexpr double kStep_mgal = 97.67;
    Line line = day({1.0});
    line.step(6, "M0", kStep_mgal);
    const auto result = line.corrected(adjustment::Prior{1.0, 0.002});
    const auto found = mistakes(result);
    REQUIRE(found.size() == 1);
    CHECK(found[0].kind == FindingKind::step);
    CHECK(std::abs(*found[0].size_mgal - kStep_mgal) < 3.0 * *found[0].u_mgal);
    // The scale turns an error of 0.2 % of a difference of gravity into an error of the step.
    CHECK(*found[0].u_mgal > 0.001);
    // A scale that only the mistake makes is not used.
    REQUIRE(result.scales.size() == 1);
    CHECK(std::abs(result.scales[0].value - 1.0) < 4.0 * 0.002);
}

TEST_CASE("readings too far from gravity for any bias are named, but not those of a gravimeter") {
    const auto found = [](double reading_mgal, int face = 1) {
        model::CorrectedRow row;
        row.row.acceleration = MilliGal(reading_mgal);
        row.row.reference = MilliGal(979800.0);
        row.row.face = face;
        return judgement::far_bias({row, row});
    };
    CHECK_FALSE(found(979800.0 + 13700.0));
    REQUIRE(found(979800.0 - 13800.0));
    CHECK_THAT(found(979800.0 - 13800.0)->text.english(),
               StartsWith("the bias of the readings comes out as -13800 mGal"));
    CHECK_THAT(found(979800.0 - 13800.0, -1)->text.english(),
               StartsWith("the bias of the readings comes out as 13800 mGal"));
    CHECK_FALSE(found(4123.0));
    CHECK_FALSE(judgement::far_bias({}));
}

TEST_CASE("a step of one of two meters is a step of this meter only") {
    Line line = day({1.0, 1.0});
    line.step(10, "M1", 0.4);
    const auto found = mistakes(line.corrected());
    REQUIRE(found.size() == 1);
    CHECK(found[0].kind == FindingKind::step);
    CHECK(std::abs(*found[0].size_mgal - 0.4) < 0.02);
    CHECK_THAT(found[0].text.english(), ContainsSubstring("M1"));
}

TEST_CASE("a step says what the prior of the scale leaves open") {
    // The stations before the step are close together, and so are those after it: only the prior says
    // that the difference of 97 mGal is a step and not a scale of zero.
    const Place a{"A", 0.0, true}, b{"B", 0.3, true}, c{"C", -97.0, true}, d{"D", -97.2, true};
    Line line;
    double hours = 0.0;
    for (const Place& place : {a, b, a, b, c, d, c, d}) line.visit(place, hours += 0.4, {1.0});
    line.step(4, "M0", 97.67);
    const auto found = mistakes(line.corrected(adjustment::Prior{1.0, 0.002}));
    const auto step = std::ranges::find(found, FindingKind::step, &Finding::kind);
    REQUIRE(step != found.end());
    CHECK(std::abs(*step->size_mgal - 97.67) < 3.0 * *step->u_mgal);
    CHECK(*step->u_mgal > 0.9 * 0.002 * 97.0);
    CHECK(*step->u_mgal < 1.5 * 0.002 * 97.0);
}

TEST_CASE("a scale that is held keeps the uncertainty of its prior") {
    // The scale of the meter is 8 standard deviations from its prior; B is 151 mGal away.
    Line line = day({1.0008});
    for (reading::SurveyRow& row : line.rows) {
        if (row.site != "A" && row.site != "C") continue;
        row.reference = MilliGal(980000.0 - (row.site == "C" ? 60.0 : 0.0));
        row.u_reference = MilliGal(0.001);
    }
    const auto result = line.corrected(adjustment::Prior{1.0, 1e-4});
    REQUIRE(mistakes(result).size() == 1);
    CHECK(mistakes(result)[0].kind == FindingKind::scale);
    CHECK(result.scales.at(0).u == Approx(1e-4).epsilon(0.01));
    const auto far = std::ranges::find(result.stations, "B", &model::StationValue::site);
    // 1e-4 of about 120 mGal beyond both references
    CHECK(far->u_gravity->value() > 0.009);
}

TEST_CASE("many loops of two meters whose scales are far from their prior are adjusted") {
    Line line;
    for (int loop = 0; loop < 20; ++loop) {
        const std::size_t first = line.rows.size();
        for (int k = 0; k < 6; ++k) {
            const double gravity_mgal = k % 3 == 0 ? 0.0 : 15.0 * loop + 7.0 * k;
            const std::string site = k % 3 == 0 ? "A" : "S" + std::to_string(2 * loop + k % 3);
            line.visit({site, gravity_mgal, k % 3 == 0}, 24.0 * loop + 0.4 * k, {1.0006, 0.9994});
        }
        for (std::size_t i = first; i < line.rows.size(); ++i) line.rows[i].loop = loop + 1;
    }
    for (reading::SurveyRow& row : line.rows)
        if (row.site != "A") row.reference.reset();
    const auto result = line.corrected();
    for (const Finding& finding : mistakes(result)) {
        INFO(finding.text.english());
        if (finding.u_mgal && finding.size_mgal)
            CHECK(std::abs(*finding.size_mgal) >= 3.0 * *finding.u_mgal);
    }
    CHECK(result.stations.size() == 41);
}
