#pragma once
/// @file
/// The tables of a long record as cells, for the terminal and the page; the first row is the header.

#include <string>
#include <vector>

#include "corrector/long_record/record_result.hpp"

namespace a351::corrector {

using TextTable = std::vector<std::vector<std::string>>;

/// The analysed one is marked by a star.
[[nodiscard]] TextTable segments_table(const RecordResult& result);
/// Statistics beside the published ones.
[[nodiscard]] TextTable statistics_table(const RecordResult& result);
/// Both ways by period; what is claimed only.
[[nodiscard]] TextTable response_table(const RecordResult& result);
/// Parameters of the two paths, and what would determine those that are not.
[[nodiscard]] TextTable two_paths_table(const RecordResult& result);

/// A line per part of the record that is not analysed.
[[nodiscard]] std::vector<std::string> refused_parts(const RecordResult& result);
/// A line per run of bands or modes that are refused for the same reason.
[[nodiscard]] std::vector<std::string> refused_bands(const RecordResult& result);
/// Which modes were taken for the cycle; empty when there are none.
[[nodiscard]] std::string chosen_modes(const RecordResult& result);
/// Static slope, what the fit leaves, and whether that still follows the temperature.
[[nodiscard]] std::string two_paths_reading(const RecordResult& result);

}  // namespace a351::corrector
