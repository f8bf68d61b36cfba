#pragma once
/// @file
/// Figures of a survey: figures 8 and 10 to 14 of the publication, the day on one axis of time, and a map.
///
/// Each function returns figures as data; draw() of drawing.hpp makes the pictures.  Rows have
/// three marks: in the fit, marked by the operator but in the fit, and left out of the fit.  In the
/// data a line of a reading ends with a comment that names it.
///
///     const std::vector<ReadingRecord> records = find_records(result, values);
///     std::vector<Figure> figures = panel_figures(result, records, print);
///     for (Figure& figure : reading_figures(result, records, print)) figures.push_back(figure);
///
/// A result must have at least one row.  Gravity and acceleration are in mGal, temperatures in
/// degC, instants in UTC.

#include <optional>
#include <vector>

#include "corrector/archive_series/temperature_course.hpp"
#include "corrector/figure/figure.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reading/signal_course.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::figure {

/// Returns the figure of acceleration over reference, with line and R2.  Rows without a reference
/// are not in it.
///
/// The tide is not removed.  The line is a least-squares line through the rows in the fit; it is
/// absent if there are fewer than three of them or if all have one reference.  The published lines
/// are reproduced (figures_test.cpp).
/// @return std::nullopt if no row has a reference, and in two faces, between which the readings differ by
///         twice the bias; so does the next one.
[[nodiscard]] std::optional<Figure> acceleration_figure(const model::SurveyCorrection& result,
                                                        const Print& print);

/// Returns the figure of difference over temperature, with line and R2.  The difference is
/// acceleration - reference - tide.  The line is that of temperature alone, whatever model was
/// applied.
[[nodiscard]] std::optional<Figure> difference_figure(const model::SurveyCorrection& result,
                                                      const Print& print);

/// Returns the figure of corrected gravity over reference, with u as bars, line and R2.
[[nodiscard]] std::optional<Figure> corrected_figure(const model::SurveyCorrection& result,
                                                     const Print& print);

/// Returns the figure of the sensor's values minus those of the reference gravimeter, over gravity,
/// with u of the sensor as bars.  Each station has its own reference hidden.
/// @return std::nullopt without a compared station.
[[nodiscard]] std::optional<Figure> side_by_side_figure(const model::SurveyCorrection& result,
                                                        const Print& print);

/// Returns a map of the stations in longitude and latitude.  The scale is the
/// same in both directions (by the cosine of the mean latitude) and is shown by a bar of a round
/// length.
///
/// Labels are placed so that they touch neither each other nor a pointer.  The caption names stations
/// whose label has no room, and those that have no position (figures_test.cpp).  Near a pole the scale of
/// the longitudes is limited.  Stations on both sides of the 180th meridian must have longitudes of one range, 0 to
/// 360.
/// @param sites  those that are no station of the survey are not shown.
/// @return std::nullopt if no station of the survey has a position in `sites`.
[[nodiscard]] std::optional<Figure> map_figure(const model::SurveyCorrection& result,
                                               const std::vector<text::Site>& sites,
                                               const Print& print);

/// The record of a row.  The pointer is into the values given to find_records(), which must outlive
/// it; it is null only in a default-constructed object.
struct ReadingRecord {
    std::size_t row = 0;  ///< Index into the survey's rows.
    const reading::RepresentativeValue* value = nullptr;
};

/// Finds the record of each row by its interval, in the order of the rows; rows without one are
/// left out.
///
/// A record belongs to a row if both intervals overlap; the first such record is taken.  Rows
/// without an interval, as from a table of averages, have no record.
/// @param values  in any order; must outlive the returned pointers.
[[nodiscard]] std::vector<ReadingRecord> find_records(
    const model::SurveyCorrection& result, const std::vector<reading::RepresentativeValue>& values);

/// Returns one figure per record: the 2 s series, its trend, the extrema and the limits of the
/// interval.
///
/// The name is reading-NN with the number of the row from 1.  The range of the axis has nine of ten
/// samples of the series and the whole trend, so that a knock does not flatten the rest.  The
/// caption has the mean over the interval; for `day` it has the averaged time and the value.  The
/// minutes that the reading uses are shaded, and their number is above the panel.
[[nodiscard]] std::vector<Figure> reading_figures(const model::SurveyCorrection& result,
                                                  const std::vector<ReadingRecord>& records,
                                                  const Print& print);

/// Returns two figures of all records side by side at one scale: accelerations and temperatures.
/// They plot the data of reading_figures().
///
/// These data files must therefore be in the same folder.  Four panels are in a line of a page, two
/// in a column.  The scale is
/// common to all panels, each about the value of its own reading.  No records give no figures.
[[nodiscard]] std::vector<Figure> panel_figures(const model::SurveyCorrection& result,
                                                const std::vector<ReadingRecord>& records,
                                                const Print& print);

/// Returns the figures of the noise in the records' parts between disturbances, pooled: noise-day, the
/// spectral density (noise::pooled_density()), and noise-day-allan (noise::pooled_allan()).  Nothing reaches
/// over a motion or from stay to stay.  Only rows in the fit take part.
/// @param data_sheet_mgal_per_sqrt_hz  noise of an axis by the data sheet; absent: no line.
/// @return none if no part is four minutes long.
[[nodiscard]] std::vector<Figure> quiet_noise_figures(
    const model::SurveyCorrection& result, const std::vector<ReadingRecord>& records,
    const std::optional<double>& data_sheet_mgal_per_sqrt_hz, const Print& print);

/// Returns the figure of the day: errors of the readings, their samples, the temperature of
/// the sensor and the signal of the recorder on one axis of time, with the stays.
///
/// The errors are those of judgement::error_of(), with u_corrected as bars (0 if there is none).  A panel
/// without data is left out.  The curve of the temperature is interrupted between minutes that are
/// not neighbours (day_figure_test.cpp).  The caption names the stays whose name has no room.
/// It plots the data of reading_figures().
/// @param course    in order of time; may be empty.
/// @param signal    a word that is not known is left out; may be empty.
[[nodiscard]] Figure day_figure(const model::SurveyCorrection& result,
                                const std::vector<ReadingRecord>& records,
                                const std::vector<archive_series::MinuteTemperature>& course,
                                const std::vector<reading::SignalSpan>& signal, const Print& print);

/// Returns the figure of both faces through the day: for each stay that has both, half the difference of
/// the readings, which is the bias, and half their sum minus the station's gravity.  Tides are removed.
/// @return std::nullopt without such a stay.
[[nodiscard]] std::optional<Figure> faces_figure(const model::SurveyCorrection& result,
                                                 const Print& print);

}  // namespace a351::corrector::figure
