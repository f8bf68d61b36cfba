#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "tests/support/catch.hpp"

namespace a351::corrector::model {

inline void add(reading::SurveyRow& row, double mgal) {
    row.acceleration = row.acceleration + MilliGal(mgal);
}

/// Removes the references of all sites but these.
inline void know_only(std::vector<reading::SurveyRow>& rows,
                      const std::vector<std::string>& sites) {
    for (reading::SurveyRow& row : rows)
        if (std::ranges::find(sites, row.site) == sites.end()) row.reference.reset();
}

}  // namespace a351::corrector::model

/// A made-up day: eight stations, the base three times, temperature, rate and drift known.
namespace a351::corrector::model::made_up {

inline constexpr double kConstant_mgal = 1800.0;
inline constexpr double kTemperature_mgal_per_degc = -30.0;
inline constexpr double kRate_mgal_per_degc_per_h = 12.0;
inline constexpr double kDrift_mgal_per_h = 0.5;

inline const UtcTime kMorning = parse_rfc3339("2020-05-01T00:00:00Z").value();

inline double gravity_mgal(const std::string& site) { return 979800.0 + 7.0 * site.back(); }

/// Returns the time since the morning.
inline double hours(const reading::SurveyRow& row) {
    return seconds_between(kMorning, row.time) / 3600.0;
}

/// Returns rows whose differences follow the model exactly.
inline std::vector<reading::SurveyRow> day() {
    const std::vector<std::string> sites{"B",  "S1", "S2", "S3", "B",  "S4",
                                         "S5", "S6", "S7", "S2", "S3", "B"};
    const std::vector<double> temperatures_degc{42.30, 42.41, 42.38, 42.55, 42.61, 42.70,
                                                42.64, 42.77, 42.90, 42.86, 42.71, 42.66};
    std::map<std::string, int> stays;
    std::vector<reading::SurveyRow> rows;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        reading::SurveyRow& row = rows.emplace_back();
        row.site = sites[i];
        row.occupation = ++stays[sites[i]];
        row.time = kMorning + std::chrono::minutes(45 * i + 3 * (i % 3));
        row.temperature = DegC(temperatures_degc[i]);
        row.tide = MilliGal(0.01 * static_cast<double>(i) - 0.05);
        row.reference = MilliGal(gravity_mgal(sites[i]));
    }
    reading::set_backward_rates(rows);
    for (reading::SurveyRow& row : rows) {
        const double effect_mgal = kConstant_mgal +
                                   kTemperature_mgal_per_degc * (row.temperature.value() - 42.6) +
                                   kRate_mgal_per_degc_per_h * row.rate_degc_per_h +
                                   kDrift_mgal_per_h * (hours(row) - 5.0);
        row.acceleration = *row.reference + row.tide + MilliGal(effect_mgal);
    }
    return rows;
}

/// Returns the day without its rate term, with a quadratic drift, and with only B known.
inline std::vector<reading::SurveyRow> day_of_network(double quadratic_mgal_per_h2 = 0.0) {
    auto rows = day();
    for (reading::SurveyRow& row : rows) {
        row.acceleration =
            row.acceleration + MilliGal(quadratic_mgal_per_h2 * std::pow(hours(row) - 5.0, 2) -
                                        kRate_mgal_per_degc_per_h * row.rate_degc_per_h);
        if (row.site != "B") row.reference.reset();
    }
    return rows;
}

/// Returns the day with these errors of its readings, again and again.
inline std::vector<reading::SurveyRow> day_with_errors(const std::vector<double>& errors_mgal) {
    auto rows = day();
    for (std::size_t i = 0; i < rows.size(); ++i) add(rows[i], errors_mgal[i % errors_mgal.size()]);
    return rows;
}

}  // namespace a351::corrector::model::made_up
