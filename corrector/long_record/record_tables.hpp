#pragma once
/// @file
/// The tables of a long record as cells, for the terminal and the page.
///
///     std::cout << text::aligned(segments_table(result));
///     const TextTable table = response_table(result);
///     add_table(page.body(), "lrrrrrr", table.front(), {table.begin() + 1, table.end()});
///
/// Cells are plain text with rounded numbers.  Programs read response.csv and result.json.  All
/// functions need a complete RecordResult, and are deterministic.

#include <string>
#include <vector>

#include "corrector/long_record/record_result.hpp"

namespace a351::corrector::long_record {

/// Cells by row; the first row is the header.  All rows have the same length.
using TextTable = std::vector<std::vector<std::string>>;

/// Returns the segments; the analysed one has a star.  Columns: number from 1, start, length in h,
/// samples from straight lines, knocks among them, reason of the start.
[[nodiscard]] TextTable segments_table(const RecordResult& result);
/// Returns the statistics and the published values.  A dash means that nothing is published.
[[nodiscard]] TextTable statistics_table(const RecordResult& result);
/// Returns the response by period in both ways, without refused points.  If all points are refused,
/// it is the header alone; refused_bands() has the reasons.
[[nodiscard]] TextTable response_table(const RecordResult& result);
/// Returns the parameters of the two paths; for undetermined ones with the record that is needed.
/// The value of an undetermined parameter is mostly that of its prior.
[[nodiscard]] TextTable two_paths_table(const RecordResult& result);

/// Returns the Allan deviations, with those of the model of three noises.
[[nodiscard]] TextTable noise_table(const RecordResult& result);
/// Returns how long an average is useful, and the levels of the three noises, in sentences.
[[nodiscard]] std::string noise_reading(const RecordResult& result);

/// Returns the effect of the temperature on the tilt, in a sentence.
/// @pre result.tilt
[[nodiscard]] std::string tilt_reading(const RecordResult& result);

/// Returns one line per part of the record that is not analysed: start, end and reason; no lines if
/// nothing was refused.
[[nodiscard]] std::vector<std::string> refused_parts(const RecordSegments& parts);
/// Returns one line per run of bands or modes that are refused for the same reason.  It has the
/// periods, the reason, and the record that is needed.
[[nodiscard]] std::vector<std::string> refused_bands(const RecordResult& result);
/// Returns a line with the modes of the cycle; empty if they were not found in both series.
[[nodiscard]] std::string chosen_modes(const RecordResult& result);
/// Returns a sentence on the static slope, on the residual of the fit, and on the bands in which
/// the residual still follows the temperature.  If there are such bands, the fit must not be
/// extrapolated, and the sentence says so.
[[nodiscard]] std::string two_paths_reading(const RecordResult& result);

}  // namespace a351::corrector::long_record
