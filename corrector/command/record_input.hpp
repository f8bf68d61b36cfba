#pragma once

#include <string>
#include <vector>

#include "corrector/long_record/archive_record.hpp"
#include "corrector/long_record/record_segments.hpp"

namespace a351::corrector {

/// Reads data roots (a day file of an archive means its root) and CSV files, each as a record.
/// A progress bar and a warning for each skipped part go to standard error.
/// @throws InputError  one cannot be read.
[[nodiscard]] std::vector<LongRecord> read_records(const std::vector<std::string>& files,
                                                   const RecordWindow& window);

/// Returns the parts found by divide_record().
/// @throws InputError  no part can be analysed; gives the reason for each.
[[nodiscard]] RecordSegments divide_or_refuse(const LongRecord& record,
                                              const SegmentOptions& options,
                                              const std::string& name);

}  // namespace a351::corrector
