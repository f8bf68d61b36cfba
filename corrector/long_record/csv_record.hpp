#pragma once

#include <filesystem>

#include "corrector/long_record/archive_record.hpp"

namespace a351::corrector {

/// A long record from a CSV, row by row: `time_utc` (or `time`; RFC 3339) or `time_s`,
/// `temperature_degc`, and `acceleration_mgal` or the axes `x_g`, `y_g`, `z_g`; other columns are
/// passed over.  Rows every 0.02, 0.2, 2 or 20 s; an empty cell or a missing row is a gap.  The tide
/// is left in, for there is no position.
/// @param progress  counts megabytes.
/// @throws InputError  a column is missing, a cell is no number, times do not ascend, another step.
[[nodiscard]] LongRecord read_csv_record(const std::filesystem::path& file,
                                         const RecordWindow& window, const Progress& progress);

/// Number of stages of 10 from that step to 20 s.
/// @return std::nullopt where none leads there within 10 %.
[[nodiscard]] std::optional<int> record_stages(double step_s);

}  // namespace a351::corrector
