#pragma once
/// @file
/// Two independent criteria for bad rows.  Both are reported; neither takes a row out.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "corrector/model/linear_fit.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector {

/// Chance of blaming a row of a clean survey, over all its rows: the customary one.
inline constexpr double kOutlierAlpha = 0.05;

/// At the some 10 mGal/(degC/h) of the sensor it makes 2 mGal, the scatter of a reading.
inline constexpr double kGreatestRate_degc_per_h = 0.2;

/// At the some 30 mGal/degC of the sensor it makes 1.5 mGal that no full wave averages out.
inline constexpr double kGreatestRange_degc = 0.05;

/// A rate above kGreatestRate_degc_per_h; a temperature that is monotone or half a wave with a range
/// above kGreatestRange_degc.
/// @return the reasons, joined by `;`, empty when there are none.
[[nodiscard]] std::string temperature_doubt(const SurveyRow& row);

/// From temperature and record alone: temperature_doubt(), and the notes fallback and pulse.
[[nodiscard]] std::string physical_doubt(const SurveyRow& row);

/// Residual / its standard deviation, s from the other rows only.
/// @param leverage   of a row of the fit its own, else what it would have.
/// @return std::nullopt when the fit leaves no degree of freedom, or the row none to itself.
/// Source: N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed., Wiley 1998, ch. 8.
[[nodiscard]] std::optional<double> studentised_residual(double residual, double leverage,
                                                         bool is_in_fit, const LinearFit& fit);

/// Limit of |studentised residual|: Student-t at kOutlierAlpha / (2 n), two-sided for n rows.
/// Without the n one clean row in twenty would be found.
/// @param dof  of the s in it, > 0.
[[nodiscard]] double studentised_limit(std::size_t n, double dof);

/// A fit to the rows in use: studentised residuals of all rows where defined, its dof.
struct StudentisedRows {
    std::vector<std::optional<double>> values;
    std::size_t dof = 0;
};
using Refit = std::function<std::optional<StudentisedRows>(const std::vector<bool>& in_use)>;

struct StatisticalDoubt {
    double studentised = 0.0;
    double limit = 0.0;
};

/// Takes the row with the largest |t| out, refits and goes on as long as it is above the limit.
/// Rows that were not in use are tested against the last fit.
/// @return one per row, set where above the limit.
[[nodiscard]] std::vector<std::optional<StatisticalDoubt>> find_outliers(std::vector<bool> in_use,
                                                                         const Refit& refit);

}  // namespace a351::corrector
