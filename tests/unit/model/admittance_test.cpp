#include "tests/unit/model/corrections.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

/// Returns the made-up day of a network with pressures of weather, and
/// with the effect of an admittance.
std::vector<SurveyRow> day_with_pressure(double admittance_mgal_per_hpa) {
    auto rows = made_up::day_of_network();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].excess_pressure_hpa = 12.0 * std::sin(1.7 * static_cast<double>(i));
        // A mountain line: the pressure follows the altitude, and so does gravity.
        rows[i].pressure_hpa = 900.0 + 0.5 * (made_up::gravity_mgal(rows[i].site) - 980300.0) +
                               0.1 * *rows[i].excess_pressure_hpa;
        rows[i].pressure_correction = MilliGal(0.0);
        add(rows[i], admittance_mgal_per_hpa * *rows[i].excess_pressure_hpa);
    }
    return rows;
}

SurveyCorrection fit_admittance(const std::vector<SurveyRow>& rows, double reading_sd_mgal) {
    SurveyOptions options = by_model("network");
    options.network.fits_admittance = true;
    options.priors.reading_sd_mgal = reading_sd_mgal;
    return correct_survey(rows, options);
}

}  // namespace

TEST_CASE("a network finds a known admittance of the air pressure") {
    const SurveyCorrection result = fit_admittance(day_with_pressure(-0.0004), 0.001);
    CHECK(coefficient(result, "admittance_mgal_per_hpa").value ==
          Approx(-0.0004).epsilon(0).margin(1e-9));
    for (const CorrectedRow& row : result.rows) {
        CHECK(row.row.pressure_correction->value() ==
              Approx(0.0004 * *row.row.excess_pressure_hpa).epsilon(0).margin(1e-8));
        CHECK(row.corrected.value() ==
              Approx(made_up::gravity_mgal(row.row.site)).epsilon(0).margin(1e-6));
    }
}

TEST_CASE("an admittance that the readings cannot distinguish from gravity is named") {
    auto rows = day_with_pressure(-0.0003);
    const std::string usual = remark(fit_admittance(rows, 0.01), "admittance");
    for (SurveyRow& row : rows) {
        row.reference = MilliGal(made_up::gravity_mgal(row.site));
        row.u_reference = MilliGal(0.001);
    }
    const std::string precise = remark(fit_admittance(rows, 0.001), "admittance");
    CAPTURE(precise, usual);
    CHECK_THAT(usual, ContainsSubstring("cannot be distinguished from gravity") &&
                          ContainsSubstring("use the fixed -0.0003") &&
                          ContainsSubstring("correlate by"));
    CHECK_FALSE(precise.empty());
    CHECK_THAT(precise, !ContainsSubstring("cannot be distinguished"));
}

TEST_CASE("only the network fits an admittance") {
    SurveyOptions options = by_model("t-drift");
    options.network.fits_admittance = true;
    CHECK_THROWS_WITH(correct_survey(day_with_pressure(0.0), options),
                      ContainsSubstring("does not fit the admittance"));
}
