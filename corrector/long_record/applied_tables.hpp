#pragma once
/// @file
/// What an applied calibration did, as cells, text and JSON; nothing where none was applied.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/long_record/record_tables.hpp"

namespace a351::corrector {

/// Scatter by period band before and after.
[[nodiscard]] TextTable applied_bands_table(const AppliedCalibration& applied);
[[nodiscard]] TextTable allan_table(const AppliedCalibration& applied);

/// Origin, what the two ways are, remarks.
[[nodiscard]] std::vector<std::string> applied_sentences(const AppliedCalibration& applied);

[[nodiscard]] std::string applied_text(const RecordResult& result);

/// Two further cells of record.csv, each with its comma.
[[nodiscard]] std::string applied_cells(const RecordResult& result, UtcTime time);

[[nodiscard]] nlohmann::ordered_json applied_json(const RecordResult& result);

}  // namespace a351::corrector
