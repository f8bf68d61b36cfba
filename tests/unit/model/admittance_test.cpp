#include <algorithm>
#include <cmath>
#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

double gravity_at_mgal(const std::string& site) { return 979800.0 + 7.0 * site.back(); }

/// Returns the made-up day without its rate term, with only B known, with pressures of weather, and
/// with the effect of an admittance.
std::vector<SurveyRow> day_with_pressure(double admittance_mgal_per_hpa) {
    auto rows = made_up::day();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].site != "B") rows[i].reference.reset();
        rows[i].acceleration = rows[i].acceleration - MilliGal(made_up::kRate_mgal_per_degc_per_h *
                                                               rows[i].rate_degc_per_h);
        rows[i].excess_pressure_hpa = 12.0 * std::sin(1.7 * static_cast<double>(i));
        // A mountain line: the pressure follows the altitude, and so does gravity.
        rows[i].pressure_hpa = 900.0 + 0.5 * (gravity_at_mgal(rows[i].site) - 980300.0) +
                               0.1 * *rows[i].excess_pressure_hpa;
        rows[i].pressure_correction = MilliGal(0.0);
        rows[i].acceleration =
            rows[i].acceleration + MilliGal(admittance_mgal_per_hpa * *rows[i].excess_pressure_hpa);
    }
    return rows;
}

SurveyCorrection fit_admittance(const std::vector<SurveyRow>& rows, double reading_sd_mgal) {
    SurveyOptions options;
    options.model = "network";
    options.network.fits_admittance = true;
    options.priors.reading_sd_mgal = reading_sd_mgal;
    return correct_survey(rows, options);
}

}  // namespace

TEST_CASE("a network finds a known admittance of the air pressure", "[survey][network]") {
    const SurveyCorrection result = fit_admittance(day_with_pressure(-0.0004), 0.001);
    const auto admittance =
        std::ranges::find(result.coefficients, "admittance_mgal_per_hpa", &Coefficient::name);
    REQUIRE(admittance != result.coefficients.end());
    CHECK(admittance->value == Approx(-0.0004).epsilon(0).margin(1e-9));
    for (const CorrectedRow& row : result.rows) {
        CHECK(row.row.pressure_correction->value() ==
              Approx(0.0004 * *row.row.excess_pressure_hpa).epsilon(0).margin(1e-8));
        CHECK(row.corrected.value() ==
              Approx(gravity_at_mgal(row.row.site)).epsilon(0).margin(1e-6));
    }
}

TEST_CASE("an admittance that the readings cannot distinguish from gravity is named",
          "[survey][network]") {
    const auto remark_of = [](const SurveyCorrection& result) {
        const auto found = std::ranges::find_if(result.remarks, [](const std::string& remark) {
            return remark.starts_with("admittance");
        });
        REQUIRE(found != result.remarks.end());
        return *found;
    };
    auto rows = day_with_pressure(-0.0003);
    const std::string usual = remark_of(fit_admittance(rows, 0.01));
    for (SurveyRow& row : rows) {
        row.reference = MilliGal(gravity_at_mgal(row.site));
        row.u_reference = MilliGal(0.001);
    }
    const std::string precise = remark_of(fit_admittance(rows, 0.001));
    CAPTURE(precise, usual);
    CHECK_THAT(usual, ContainsSubstring("cannot be distinguished from gravity") &&
                          ContainsSubstring("use the fixed -0.0003") &&
                          ContainsSubstring("correlate by"));
    CHECK_THAT(precise, !ContainsSubstring("cannot be distinguished"));
}

TEST_CASE("only the network fits an admittance", "[survey][network]") {
    SurveyOptions options;
    options.model = "t-drift";
    options.network.fits_admittance = true;
    CHECK_THROWS_WITH(correct_survey(day_with_pressure(0.0), options),
                      ContainsSubstring("does not fit the admittance"));
}
