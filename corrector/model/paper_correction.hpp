#pragma once
/// @file
/// The correction of the publication, step by step, as its tables (not always its text) show it:
/// S. Matsuda, K. Nakasendo, H. Morikawa, K. Iiyama and K. Sakai, "An experimental study on basic
/// performances of accelerometer with crystal oscillator" (in Japanese).
///
///     D_i  = G_i - g_i - tide_i                    Difference
///     D    = a T + b                               least squares over the rows in use
///     G1_i = G_i - tide_i - (a T_i + b)            Corrected (1);  e1_i = g_i - G1_i
///     G2_i = G1_i + e1_first + (e1_last - e1_first) (t_i - t_first) / (t_last - t_first)
///
/// where first and last are the ends of the day at the base station.
/// Vectors hold one value per row, in mGal; NaN where the reference is unknown.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/survey_row.hpp"

namespace a351::corrector {

struct TemperatureLine {
    double slope_mgal_per_degc = 0.0;
    MilliGal intercept;  ///< At 0 degC: 42 degC outside the data, so good to some mGal only.
    double r_squared = 0.0;
};

[[nodiscard]] std::vector<double> differences_mgal(const std::vector<SurveyRow>& rows);

/// @param in_use  one per row; rows without a reference are left out as well.
/// @return std::nullopt with fewer than two such rows or a constant temperature.
[[nodiscard]] std::optional<TemperatureLine> fit_temperature_line(
    const std::vector<SurveyRow>& rows, const std::vector<bool>& in_use);

[[nodiscard]] std::vector<double> temperature_corrected_mgal(const std::vector<SurveyRow>& rows,
                                                             const TemperatureLine& line);

/// reference - corrected.
[[nodiscard]] std::vector<double> errors_mgal(const std::vector<SurveyRow>& rows,
                                              const std::vector<double>& corrected_mgal);

/// The straight line between the errors of the first and the last occupation of the base.
struct EndPointDrift {
    UtcTime first, last;
    MilliGal first_error, last_error;

    [[nodiscard]] MilliGal total() const { return last_error - first_error; }
    [[nodiscard]] double rate_mgal_per_h() const;
    [[nodiscard]] MilliGal at(UtcTime time) const;
};

/// The drift step, or the reason why it is refused: fewer than two occupations of the base, both
/// ends not in use, or a base without reference gravity.
struct DriftStep {
    std::optional<EndPointDrift> drift;
    std::string refusal;  ///< Empty when `drift` is there.
};
[[nodiscard]] DriftStep find_end_point_drift(const std::vector<SurveyRow>& rows,
                                             const std::vector<bool>& in_use,
                                             const std::vector<double>& corrected1_mgal,
                                             std::string_view base);

[[nodiscard]] std::vector<double> drift_corrected_mgal(const std::vector<SurveyRow>& rows,
                                                       const std::vector<double>& corrected1_mgal,
                                                       const EndPointDrift& drift);

/// sqrt(sum of squares / n) over the rows in use: divisor n, mean not removed.
/// @return NaN without such rows.
[[nodiscard]] MilliGal rms(const std::vector<double>& errors_mgal, const std::vector<bool>& in_use);

}  // namespace a351::corrector
