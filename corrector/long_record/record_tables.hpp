#pragma once
/// @file
/// The tables of a long record as cells, for the terminal and the page.

#include <string>
#include <vector>

#include "corrector/long_record/record_result.hpp"

namespace a351::corrector {

/// Cells by row; the first row is the header.
using TextTable = std::vector<std::vector<std::string>>;

/// Returns the segments; the analysed one has a star.
[[nodiscard]] TextTable segments_table(const RecordResult& result);
/// Returns the statistics and the published values.
[[nodiscard]] TextTable statistics_table(const RecordResult& result);
/// Returns the response by period in both ways, without refused points.
[[nodiscard]] TextTable response_table(const RecordResult& result);
/// Returns the parameters of the two paths; for undetermined ones with the record that is needed.
[[nodiscard]] TextTable two_paths_table(const RecordResult& result);

/// Returns one line per part of the record that is not analysed.
[[nodiscard]] std::vector<std::string> refused_parts(const RecordResult& result);
/// Returns one line per run of bands or modes that are refused for the same reason.
[[nodiscard]] std::vector<std::string> refused_bands(const RecordResult& result);
/// Returns a line with the modes of the cycle; empty if they were not found in both series.
[[nodiscard]] std::string chosen_modes(const RecordResult& result);
/// Returns a sentence on the static slope, on the residual of the fit, and on the bands in which
/// the residual still follows the temperature.
[[nodiscard]] std::string two_paths_reading(const RecordResult& result);

}  // namespace a351::corrector
