#pragma once

#include <string>
#include <vector>

#include "corrector/long_record/archive_record.hpp"
#include "corrector/long_record/record_segments.hpp"

namespace a351::corrector {

/// Data roots (or day files of their archives, which stand for them) and CSVs, each as a record; a
/// progress bar and what was passed over go to standard error.
/// @throws InputError  one cannot be read.
[[nodiscard]] std::vector<LongRecord> read_records(const std::vector<std::string>& files,
                                                   const RecordWindow& window);

/// divide_record() where something is left to be analysed.
/// @throws InputError  in words, why there is not.
[[nodiscard]] RecordSegments divide_or_refuse(const LongRecord& record,
                                              const SegmentOptions& options,
                                              const std::string& name);

}  // namespace a351::corrector
