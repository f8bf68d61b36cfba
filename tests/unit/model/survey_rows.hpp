#pragma once

#include <map>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"

/// A made-up day: eight stations, the base three times, temperature, rate and drift known.
namespace a351::corrector::model::made_up {

inline constexpr double kConstant_mgal = 1800.0;
inline constexpr double kTemperature_mgal_per_degc = -30.0;
inline constexpr double kRate_mgal_per_degc_per_h = 12.0;
inline constexpr double kDrift_mgal_per_h = 0.5;

inline const UtcTime kMorning = parse_rfc3339("2020-05-01T00:00:00Z").value();

/// Returns rows whose differences follow the model exactly.
inline std::vector<reading::SurveyRow> day() {
    const std::vector<std::string> sites{"B",  "S1", "S2", "S3", "B",  "S4",
                                         "S5", "S6", "S7", "S2", "S3", "B"};
    const std::vector<double> temperatures_degc{42.30, 42.41, 42.38, 42.55, 42.61, 42.70,
                                                42.64, 42.77, 42.90, 42.86, 42.71, 42.66};
    std::map<std::string, int> stays;
    std::vector<reading::SurveyRow> rows;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        reading::SurveyRow row;
        row.site = sites[i];
        row.occupation = ++stays[sites[i]];
        row.time = kMorning + std::chrono::minutes(45 * i + 3 * (i % 3));
        row.temperature = DegC(temperatures_degc[i]);
        row.tide = MilliGal(0.01 * static_cast<double>(i) - 0.05);
        row.reference = MilliGal(979800.0 + 7.0 * static_cast<double>(sites[i].back()));
        rows.push_back(row);
    }
    reading::set_backward_rates(rows);
    for (reading::SurveyRow& row : rows) {
        const double hours = seconds_between(kMorning, row.time) / 3600.0;
        const double effect_mgal =
            kConstant_mgal + kTemperature_mgal_per_degc * (row.temperature.value() - 42.6) +
            kRate_mgal_per_degc_per_h * row.rate_degc_per_h + kDrift_mgal_per_h * (hours - 5.0);
        row.acceleration = *row.reference + row.tide + MilliGal(effect_mgal);
    }
    return rows;
}

}  // namespace a351::corrector::model::made_up
