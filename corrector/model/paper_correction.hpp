#pragma once
/// @file
/// The correction of the publication, step by step.  It follows the tables, which differ from the
/// text in places (tests/golden/tsukuba/README.md): S. Matsuda, K. Nakasendo, H. Morikawa, K.
/// Iiyama and K. Sakai, "An experimental study on basic performances of accelerometer with crystal
/// oscillator" (in Japanese).
///
///     D_i  = G_i - g_i - tide_i                    Difference
///     D    = a T + b                               least squares over the rows in use
///     G1_i = G_i - tide_i - (a T_i + b)            Corrected (1), equation (3);  e1_i = g_i - G1_i
///     G2_i = G1_i + e1_first + (e1_last - e1_first) (t_i - t_first) / (t_last - t_first)
///
/// G is the reading, g the reference, T the temperature.  Equation (3) is printed with g in place
/// of G.  First and last are the first and the last row of the base station.
///
/// Use it to reproduce the publication; for results use another model.  Programs take
/// paper_model().  The steps, in their order:
///
///     const auto line = fit_temperature_line(rows, in_use);
///     const auto corrected1 = temperature_corrected_mgal(rows, *line);
///     const DriftStep step = find_end_point_drift(rows, in_use, corrected1, base);
///     const auto corrected2 = drift_corrected_mgal(rows, corrected1, *step.drift);
///     const MilliGal error = rms(errors_mgal(rows, corrected2), in_use);
///
/// All functions are pure.  Lengths of vectors are not checked.
/// Vectors hold one value per row (n), mGal.  Values that need an unknown reference are NaN.
///
/// Accuracy: tests/golden/tsukuba_correction_test.cpp and tsukuba_models_test.cpp compare each step
/// with the printed tables.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/score.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::model {

/// A straight line y = a x + b by least squares, in centred form.
struct Line {
    double slope = 0.0, intercept = 0.0;
    double r_squared = 0.0;  ///< 1 - RSS / sum (y - mean)^2; NaN for constant y.
    double mean_x = 0.0, mean_y = 0.0;
    double slope_cofactor = 0.0;  ///< 1 / sum (x - mean)^2
    std::size_t count = 0;        ///< Number of points.
    double rss = 0.0;             ///< Sum of squared residuals.

    /// Returns the value of the line, centred: b contains the rounding of large x.
    [[nodiscard]] double at(double x) const { return mean_y + (x - mean_x) * slope; }
    /// Returns 1/n + (x - mean)^2 / sum (x - mean)^2; of a point of the fit its leverage.
    [[nodiscard]] double leverage_at(double x) const {
        return 1.0 / static_cast<double>(count) + slope_cofactor * (x - mean_x) * (x - mean_x);
    }
};

/// Fits a line.
/// @param x, y  (n) finite.
/// @return std::nullopt with fewer than two points, or for a constant x.
[[nodiscard]] std::optional<Line> line_through(const std::vector<double>& x,
                                               const std::vector<double>& y);

/// Returns the Difference D_i = G_i - g_i - tide_i of every row (n), mGal; NaN without a reference.
[[nodiscard]] std::vector<double> differences_mgal(const std::vector<reading::SurveyRow>& rows);

/// Fits the line D = a T + b by least squares: a in mGal/degC, about -29 for the published rows, and b
/// at 0 degC, mGal.  It is the effect on the reading, which is subtracted.  b is 42 degC outside the
/// data, so it is known to a few mGal only.
///
/// There are no priors.  Two rows determine the line without a residual.
/// @param rows    (n), finite.
/// @param in_use  (n) rows of the fit; rows without a reference are left out as well.
/// @return std::nullopt with fewer than two such rows or a constant temperature.
[[nodiscard]] std::optional<Line> fit_temperature_line(const std::vector<reading::SurveyRow>& rows,
                                                       const std::vector<bool>& in_use);

/// Returns Corrected (1) of every row (n): G1_i = G_i - tide_i - (a T_i + b), mGal.  No reference
/// is needed.
[[nodiscard]] std::vector<double> temperature_corrected_mgal(
    const std::vector<reading::SurveyRow>& rows, const Line& line);

/// Returns the errors reference - corrected of every row (n), mGal; NaN without a reference.
/// @param corrected_mgal  (n) corrected values.
[[nodiscard]] std::vector<double> errors_mgal(const std::vector<reading::SurveyRow>& rows,
                                              const std::vector<double>& corrected_mgal);

/// The straight line between the errors e1 of the first and the last row of the base.
///
/// It is added to Corrected (1).  Both rows of the base then have the error 0, so errors there say
/// nothing about the quality of the correction.  `last` is later than `first`.
struct EndPointDrift {
    UtcTime first, last;               ///< Times of both rows.
    MilliGal first_error, last_error;  ///< e1 of both rows.

    /// Returns e1_last - e1_first.
    [[nodiscard]] MilliGal total() const { return last_error - first_error; }
    /// Returns total() divided by the time between both rows.
    [[nodiscard]] double rate_mgal_per_h() const;
    /// Returns e1_first + (e1_last - e1_first) (t - t_first) / (t_last - t_first), also outside the
    /// two rows.
    [[nodiscard]] MilliGal at(UtcTime time) const;
};

/// The drift step, or the reason why it is refused.
struct DriftStep {
    std::optional<EndPointDrift> drift;  ///< Absent: see `refusal`.
    std::string refusal;                 ///< Reason; empty if there is a drift.
};

/// Returns the drift between the first and the last row of the base.
///
/// It is refused if the base has fewer than two occupations, if it has no reference gravity, or if
/// neither end is in use.
///
/// One end in use is enough.  Several set-ups of one stay count as one occupation.
/// @param rows             (n) in ascending time; all rows of the base have the same reference.
/// @param in_use           (n)
/// @param corrected1_mgal  (n) Corrected (1).
/// @param base             name of the base station.
[[nodiscard]] DriftStep find_end_point_drift(const std::vector<reading::SurveyRow>& rows,
                                             const std::vector<bool>& in_use,
                                             const std::vector<double>& corrected1_mgal,
                                             std::string_view base);

/// Returns Corrected (2) of every row (n): G2_i = G1_i + drift at t_i, mGal.  Rows before the first
/// and after the last row of the base are extrapolated.
[[nodiscard]] std::vector<double> drift_corrected_mgal(const std::vector<reading::SurveyRow>& rows,
                                                       const std::vector<double>& corrected1_mgal,
                                                       const EndPointDrift& drift);

/// Returns sqrt(sum e^2 / n) over the rows in use: divisor n, mean not removed.
/// @param errors_mgal  (n) errors; NaN is skipped and does not count in n.
/// @param in_use       (n)
/// @return NaN without such rows.
[[nodiscard]] MilliGal rms(const std::vector<double>& errors_mgal, const std::vector<bool>& in_use);

/// Returns the scores of the publication's correction (paper_correction.hpp).
///
/// The temperature line is fitted to the rows in use.  The ends of the drift are the first and the
/// last row of the base, in use or not.  p is 4.
///
/// LOSO is absent because the base cannot be left out.  AICc is absent because the correction is no
/// least-squares fit.  LOO leaves out each row in use in turn; without an end of the drift, the
/// next row of the base takes its place.
///
/// Accuracy: rms before and after the drift step, 2.0084 and 2.6249 mGal for the published rows,
/// agree within 0.0001 mGal (tests/golden/tsukuba_models_test.cpp).
/// @param rows    (n) in ascending time.
/// @param in_use  (n), true only for rows with a reference.
/// @param base    name of the base station.
/// @return rms_before_drift_mgal only if the drift step is refused; no score without a line.
[[nodiscard]] Score score_paper_model(const std::vector<reading::SurveyRow>& rows,
                                      const std::vector<bool>& in_use, std::string_view base);

}  // namespace a351::corrector::model
