#pragma once
/// @file
/// A long record from a CSV file.
///
/// Use it for records of other programs.  For a data root use read_archive_record(), which knows
/// the scale, the position and the serial number.  A file at 20 s with a missing value:
///
///     time_s,acceleration_mgal,temperature_degc
///     0,979763.12,42.4981
///     20,,42.4985

#include <filesystem>

#include "corrector/long_record/archive_record.hpp"

namespace a351::corrector::long_record {

/// Reads a long record from a CSV, row by row, and decimates it.
///
/// - Columns: `time_utc` (or `time`; RFC 3339) or `time_s`; `temperature_degc`; `acceleration_mgal`
///   or the axes `x_g`, `y_g`, `z_g`.  Other columns are skipped.
/// - Rows come every 0.02, 0.2, 2 or 20 s within 10 %.  An empty cell or a missing row is a gap; a
///   gap of more than an hour begins a new stretch.
/// - The tide is not removed, because the position is not known.
/// - The sensor's serial number is not known.
/// - With any column of an axis, all three are needed, and acceleration_mgal is not used.  Their
///   norm is taken after the decimation.
/// - Numbers in the time column are taken as seconds since 1970.
/// - acceleration_mgal may count from any zero.  Gravity in m/s2, Gal or g is refused, unless it
///   scatters (median absolute deviation) by 0.01 of that unit or more.
///
/// The step is the median of the first 1000 rows.  Time stamps may scatter: a row less than half a
/// step after another is the next row.  Rows that are missing here and there do not change the step
/// (record_reading_test.cpp).  Memory grows with the decimated record only.
/// @param file      the CSV; a regular file, not a pipe.
/// @param window    part to be read.
/// @param progress  called with the megabytes done and in all.
/// @throws InputError  if a column is missing, a cell is no number or out of range, times do not
///                     ascend, there are fewer than two rows, rows have another step, or the
///                     acceleration is in another unit; with file and line, or the median.
[[nodiscard]] LongRecord read_csv_record(const std::filesystem::path& file,
                                         const RecordWindow& window,
                                         const archive_series::Progress& progress);

/// Returns the number of decimation stages of 10 from a step to 20 s, 0 to kMostRecordStages: 3 for
/// 0.02 s, 0 for 20 s.
/// @param step_s  time between samples, s.
/// @return std::nullopt if no number of stages leads there within 10 %.
[[nodiscard]] std::optional<int> record_stages(double step_s);

}  // namespace a351::corrector::long_record
