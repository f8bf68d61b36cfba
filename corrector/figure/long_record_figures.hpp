#pragma once
/// @file
/// Figures of a long record at one point: figures 2 to 7 of the publication, the response by
/// period, and the effect of a calibration.
///
/// The figures have the data of the analysed segment, with two exceptions: record-raw shows all
/// stretches, and record-20s all segments.  Times are hours after an instant that the axis names.
/// Accelerations are in mGal, temperatures in degC.
///
/// draw() of drawing.hpp makes the pictures; make_long_record_page() of report.hpp does all of it.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/long_record/record_result.hpp"

namespace a351::corrector::figure {

/// Returns the publication's figures.  Of a long series the least and the greatest value of each of
/// 1500 steps are drawn, of a long scatter at most kMostPoints points at equal distances.
///
/// Names in order: record-raw (2), record-20s (2), trend (4), decomposition, modes (5),
/// scatter-modes (6), correlation (7), scatter (3), with the publication's numbers in brackets.
/// - record-raw is absent if no part of the record was decimated.
/// - modes, scatter-modes and correlation are absent without RecordAnalysis::modes.
/// - modes shows the middle 8 h of a longer segment, 4 h in a column.
/// @param result  analysed, with at least one stretch.
[[nodiscard]] std::vector<Figure> long_record_figures(const long_record::RecordResult& result,
                                                      const Print& print);

/// Returns the figure of a tilt: as measured and as corrected to the mean temperature, minus the mean of
/// the corrected values, above the temperature.  All segments are shown.
/// @pre result.tilt
[[nodiscard]] Figure tilt_figure(const long_record::RecordResult& result, const Print& print);

/// Returns the figure of gain and phase by period, from spectra and from modes, with the two-path
/// fit.
///
/// Refused points are left out.  The fit is drawn from 240 s to the length of the segment, with its
/// 95 % limits by linear propagation of the covariance.  Phase is positive if the acceleration
/// leads.  Without any point the figure has the fit alone.
[[nodiscard]] Figure response_figure(const long_record::RecordResult& result, const Print& print);

/// Returns the figures of the noise of the acceleration: noise-spectrum, with the three noises of the
/// Allan deviation, Peterson's models of the ground and the data sheet, and noise-allan, both with 95 % limits, and
/// noise-spectrogram by the hour.
[[nodiscard]] std::vector<Figure> noise_figures(const long_record::RecordResult& result,
                                                const Print& print);

/// Returns the figures of a record before and after a calibration was applied: the series, and
/// their Allan deviations.
///
/// Both ways of correction are shown, parametric and by modes.  A long series is drawn as means of
/// neighbours, at most kMostPoints of them, minus the mean of the whole.
/// @pre result.applied
[[nodiscard]] std::vector<Figure> applied_figures(const long_record::RecordResult& result,
                                                  const Print& print);

}  // namespace a351::corrector::figure
