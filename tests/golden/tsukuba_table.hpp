#pragma once

#include <string>
#include <vector>
#include "tests/support/catch.hpp"

#include "corrector/reading/survey_row.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/sites.hpp"

/// The published survey.  Origin, signs and known slips: tests/golden/tsukuba/README.md.
namespace a351::corrector::tsukuba {

inline std::vector<text::Site> sites() {
    return text::read_sites(A351_GOLDEN "/tsukuba/sites.csv");
}

/// The 19 rows with the published tide.
inline std::vector<reading::SurveyRow> observations() {
    auto rows = reading::read_observations(A351_GOLDEN "/tsukuba/observations.csv", sites());
    tide::apply_tide(rows, {}, {"given", {}, {}});
    REQUIRE(rows.size() == 19);
    return rows;
}

/// The same with the temperatures worked back from the printed results.
inline std::vector<reading::SurveyRow> with_recovered_temperature() {
    auto rows = observations();
    const auto table = text::read_csv(A351_GOLDEN "/tsukuba/temperature_recovered.csv");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        REQUIRE(table.cell(i, "site") == rows[i].site);
        rows[i].temperature = DegC(table.number(i, "temperature_recovered_degc"));
    }
    return rows;
}

/// A column of expected.csv, as the publication prints it.
inline std::vector<double> printed(const std::string& column) {
    const auto table = text::read_csv(A351_GOLDEN "/tsukuba/expected.csv");
    const auto rows = observations();
    std::vector<double> values;
    for (std::size_t i = 0; i < table.row_count(); ++i) {
        REQUIRE(table.cell(i, "site") == rows.at(i).site);
        values.push_back(table.number(i, column));
    }
    return values;
}

/// The 16 rows without the publication's dagger.
inline std::vector<bool> unflagged() {
    std::vector<bool> in_use;
    for (const reading::SurveyRow& row : observations()) in_use.push_back(!row.is_flagged);
    return in_use;
}

}  // namespace a351::corrector::tsukuba
