#include "corrector/model/survey_correction.hpp"

#include "corrector/model/trend_comparison.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/unit/model/corrections.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

TEST_CASE("corrections of each linear model add up to the corrected value") {
    auto rows = made_up::day();
    add(rows[2], 1.5);
    const std::string model = GENERATE("paper", "t", "t-rate", "t-drift", "t-rate-drift", "auto");
    CAPTURE(model);
    for (const CorrectedRow& row : correct_survey(rows, by_model(model)).rows) {
        CHECK(sum_mgal(row) == Approx(row.corrected.value()).epsilon(0).margin(1e-8));
        CHECK(row.residual->value() ==
              Approx((row.corrected - *row.row.reference).value()).margin(1e-12));
    }
}

TEST_CASE("a station without a reference gets its true value") {
    auto rows = made_up::day();
    const MilliGal truth = *rows[6].reference;
    rows[6].reference.reset();
    const auto result = correct_survey(rows, by_model("t-rate-drift"));
    CHECK_FALSE(result.rows[6].is_used);
    CHECK_FALSE(result.rows[6].residual.has_value());
    CHECK(result.rows[6].corrected.value() == Approx(truth.value()).epsilon(0).margin(1e-6));
}

TEST_CASE("an unknown station at a temperature outside those of the fit is named") {
    auto rows = made_up::day();
    const auto remark_of = [](const std::vector<SurveyRow>& survey) {
        return remark(correct_survey(survey, by_model("t-rate")), "temperature outside");
    };
    CHECK(remark_of(rows).empty());
    rows[6].reference.reset();  // S5 at 42.64 degC
    CHECK(remark_of(rows).empty());
    rows[6].temperature = DegC(42.94);  // The warmest known reading has 42.90 degC.
    CHECK(remark_of(rows).empty());
    rows[6].temperature = DegC(43.10);
    CHECK(
        remark_of(rows) ==
        "temperature outside 42.30 to 42.90 degC, that of the known stations in the fit, by up to "
        "0.20 degC: the temperature correction is extrapolated for S5 (1)");
    rows[6].is_excluded = true;
    CHECK(remark_of(rows).empty());
}

TEST_CASE("stations outside the datum are not in the fit but have a residual") {
    auto options = by_model("t");
    options.datum = {"B", "S2", "S3"};
    const auto result = correct_survey(made_up::day(), options);
    for (const CorrectedRow& row : result.rows) {
        const bool is_datum = row.row.site == "B" || row.row.site == "S2" || row.row.site == "S3";
        CHECK(row.is_used == is_datum);
        CHECK(row.residual.has_value());
    }
    CHECK(result.score.row_count == 7);
}

TEST_CASE("a flagged row is not in the fit unless flags are ignored") {
    auto rows = made_up::day();
    rows[3].is_flagged = true;
    add(rows[3], 50.0);
    auto options = by_model("t-rate-drift");
    const auto used = correct_survey(rows, options);
    CHECK(used.score.row_count == 11);
    CHECK(used.score.rms_mgal.value() < 1e-6);
    CHECK(used.rows[3].residual->value() == Approx(50.0));
    options.use_flags = false;
    const auto all = correct_survey(rows, options);
    CHECK(all.score.row_count == 12);
    CHECK(all.score.rms_mgal.value() > 1.0);
    // Both row sets are listed with either setting.
    for (const auto& result : {used, all}) {
        REQUIRE(result.row_sets.size() == 2);
        CHECK(result.row_sets[0].scores[4].row_count == 11);
        CHECK(result.row_sets[1].scores[4].row_count == 12);
    }
}

TEST_CASE("an excluded row is in no fit and no mean, even if flags are ignored") {
    auto rows = made_up::day();
    rows[3].is_excluded = true;
    add(rows[3], 50.0);
    auto options = by_model("t-rate-drift");
    options.use_flags = false;
    const auto result = correct_survey(rows, options);
    CHECK(result.row_sets[1].scores[4].row_count == 11);
    CHECK(result.score.rms_mgal.value() < 1e-6);
    CHECK(std::abs(station(result, "S3").residual->value()) < 1e-6);
}

TEST_CASE("a station with flagged rows only gets their mean and is marked") {
    auto rows = made_up::day();
    rows[1].is_flagged = true;
    const auto result = correct_survey(rows, by_model("t-rate-drift"));
    REQUIRE(result.stations[1].site == "S1");
    CHECK(result.stations[1].is_flagged_only);
    CHECK_FALSE(result.stations[1].redundancy.has_value());
    CHECK(result.stations[1].gravity.value() ==
          Approx(rows[1].reference->value()).epsilon(0).margin(1e-6));
}

TEST_CASE("redundancies of the stations add up to the degrees of freedom") {
    auto rows = made_up::day();
    rows[5].is_flagged = true;
    double sum = 0.0;
    for (const StationValue& station : correct_survey(rows, by_model("t-rate")).stations)
        sum += station.redundancy.value_or(0.0);
    CHECK(sum == Approx(11.0 - 3.0));
}

TEST_CASE("the uncertainty of a new station is s sqrt(1 + leverage)") {
    auto rows = made_up::day();
    add(rows[2], 2.0);
    const auto result = correct_survey(rows, by_model("t-rate-drift"));
    for (const CorrectedRow& row : result.rows)
        CHECK(row.u_corrected->value() ==
              Approx(result.score.s_mgal.value() * std::sqrt(1.0 + row.leverage.value())));
}

TEST_CASE("a survey that cannot be corrected is refused with a reason") {
    auto rows = made_up::day();
    auto options = by_model("t");
    SECTION("unknown base") {
        options.base = "S9";
        CHECK_THROWS_WITH(correct_survey(rows, options),
                          ContainsSubstring("base = S9") && ContainsSubstring("B, S1"));
    }
    SECTION("unknown datum") {
        options.datum = {"B", "S9"};
        CHECK_THROWS_WITH(correct_survey(rows, options), ContainsSubstring("datum = S9"));
    }
    SECTION("unknown model") {
        options.model = "kriging";
        CHECK_THROWS_WITH(correct_survey(rows, options), ContainsSubstring("model = kriging") &&
                                                             ContainsSubstring("t-rate-drift"));
    }
    SECTION("constant temperature") {
        for (SurveyRow& row : rows) row.temperature = DegC(42.5);
        CHECK_THROWS_WITH(correct_survey(rows, options), ContainsSubstring("do not determine"));
    }
    SECTION("too few rows") {
        rows.resize(3);
        options.model = "t-rate-drift";
        CHECK_THROWS_WITH(correct_survey(rows, options),
                          ContainsSubstring("3 rows") && ContainsSubstring("at least 4"));
    }
    SECTION("paper with a base occupied once") {
        options.model = "paper";
        options.base = "S1";
        CHECK_THROWS_WITH(correct_survey(rows, options),
                          ContainsSubstring("drift step is refused"));
    }
    SECTION("no rows at all") { CHECK_THROWS_AS(correct_survey({}, options), InputError); }
}

TEST_CASE("the difference of the trends is summarised with the site of the largest") {
    SurveyCorrection result;
    CHECK(trend_comparison_text(result).empty());
    for (const auto& [site, occupation, difference_mgal] :
         {std::tuple("No.0", 1, 0.3), {"No.5", 2, -0.4}, {"No.7", 1, 0.0}}) {
        SurveyRow& row = result.rows.emplace_back().row;
        row.site = site;
        row.occupation = occupation;
        if (difference_mgal == 0.0) continue;
        RecordSummary& record = row.record.emplace();
        record.eemd_mean = MilliGal(979'800.0);
        record.smoother_mean = record.eemd_mean + MilliGal(difference_mgal);
    }
    CHECK(trend_comparison_text(result) ==
          "trends, smoother minus EEMD: mean -0.050, rms 0.354, largest -0.400 mGal at No.5 (2)\n");
}
