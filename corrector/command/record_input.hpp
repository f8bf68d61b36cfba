#pragma once
/// @file
/// Long records as the user names them on the command line.
///
///     const LongRecord record = joined_record(read_records(options.files, window));
///     const RecordSegments parts = divide_or_refuse(record, {}, options.files.front());

#include <string>
#include <vector>

#include "corrector/long_record/archive_record.hpp"
#include "corrector/long_record/record_segments.hpp"

namespace a351::corrector::command {

/// Reads data roots (a day file of an archive means its root) and CSV files, each as a record.
/// A progress bar and a warning for each skipped part go to standard error.
///
/// A data root that is named several times, or by several of its day files, is read once.  Any file
/// that is not in an archive is taken as CSV.
/// @param files   existing paths; symbolic links are followed.
/// @param window  part to be read, the same for all.
/// @param system  tide system of the records from archives.
/// @return records in the order of the files.
/// @throws std::filesystem::filesystem_error  a path does not exist.
/// @throws InputError  one cannot be read.
[[nodiscard]] std::vector<long_record::LongRecord> read_records(
    const std::vector<std::string>& files, const long_record::RecordWindow& window,
    tide::System system = tide::System::tide_free);

/// Returns the parts found by divide_record(), with at least one segment.
/// @param name  of the record, for the message.
/// @throws InputError  no part can be analysed; gives the reason for each.
[[nodiscard]] long_record::RecordSegments divide_or_refuse(
    const long_record::LongRecord& record, const long_record::SegmentOptions& options,
    const std::string& name);

}  // namespace a351::corrector::command
