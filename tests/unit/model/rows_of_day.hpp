#pragma once

#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/whole_day/made_up_day.hpp"

namespace a351::corrector::model {

/// Returns the rows of a MadeUpDay.  Set-ups 11 to 15 are at the stations of 0 to 4.
inline std::vector<reading::SurveyRow> rows_of(const reading::DayRecord& day) {
    std::vector<reading::SurveyRow> rows;
    for (std::size_t s = 0; s < whole_day::MadeUpDay::kSetUps; ++s) {
        reading::SurveyRow& row = rows.emplace_back();
        row.site = "S" + std::to_string(s % 11);
        row.occupation = s < 11 ? 1 : 2;
        row.time = day.bins[s * whole_day::MadeUpDay::kBins + whole_day::MadeUpDay::kBins / 2].time;
        row.acceleration = day.bins[s * whole_day::MadeUpDay::kBins].reading;
        row.temperature = DegC(42.5 + 0.1 * static_cast<double>(s * s % 7));
        row.reference = MilliGal(whole_day::MadeUpDay::gravity_mgal(s));
    }
    return rows;
}

/// Returns the true gravity of a site of these rows.
inline double gravity_of(const std::string& site) {
    return whole_day::MadeUpDay::gravity_mgal(static_cast<std::size_t>(std::stoi(site.substr(1))));
}

}  // namespace a351::corrector::model
