#pragma once
/// @file
/// Figures of a survey: figures 10 to 14 of the publication, the residuals and the temperature in
/// time, and a map.

#include <optional>
#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reading/temperature_course.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// Returns the figure of acceleration over reference, with line and R2.  Rows without a reference
/// are not in it.
/// @return std::nullopt if no row has a reference; so do the next two.
[[nodiscard]] std::optional<Figure> acceleration_figure(const SurveyCorrection& result);

/// Returns the figure of difference over temperature, with line and R2.
[[nodiscard]] std::optional<Figure> difference_figure(const SurveyCorrection& result);

/// Returns the figure of corrected value over reference, with the line y = x.
[[nodiscard]] std::optional<Figure> corrected_figure(const SurveyCorrection& result);

/// Returns the figure of residual over time, with the standard uncertainty of a new station.
[[nodiscard]] std::optional<Figure> residual_figure(const SurveyCorrection& result);

/// Returns the figure of the day's temperature with the readings; without a course, of the readings
/// only.
[[nodiscard]] Figure temperature_figure(const SurveyCorrection& result,
                                        const std::vector<MinuteTemperature>& course);

/// Returns a map of the stations in longitude and latitude with their heights.  The scale is the
/// same in both directions (by the cosine of the mean latitude) and is shown by a bar of a round
/// length.
/// @return std::nullopt if no station of the survey has a position in `sites`.
[[nodiscard]] std::optional<Figure> map_figure(const SurveyCorrection& result,
                                               const std::vector<text::Site>& sites);

/// The record of a row.
struct ReadingRecord {
    std::size_t row = 0;  ///< Index into the survey's rows.
    const RepresentativeValue* value = nullptr;
};

/// Finds the record of each row by its interval, in the order of the rows; rows without one are
/// left out.
[[nodiscard]] std::vector<ReadingRecord> find_records(
    const SurveyCorrection& result, const std::vector<RepresentativeValue>& values);

/// Returns one figure per record: the 2 s series, its trend, the extrema and the limits of the
/// interval.
[[nodiscard]] std::vector<Figure> reading_figures(const SurveyCorrection& result,
                                                  const std::vector<ReadingRecord>& records);

/// Returns two figures of all records side by side at one scale: accelerations and temperatures.
/// They plot the data of reading_figures().
[[nodiscard]] std::vector<Figure> panel_figures(const SurveyCorrection& result,
                                                const std::vector<ReadingRecord>& records);

}  // namespace a351::corrector
