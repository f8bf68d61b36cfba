#pragma once
/// @file
/// Effect of an applied calibration as table cells, text and JSON.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/long_record/record_tables.hpp"

namespace a351::corrector {

/// Returns the scatter by period band, before and after, mGal.
[[nodiscard]] TextTable applied_bands_table(const AppliedCalibration& applied);
/// Returns the Allan deviations by averaging time, before and after, mGal.
[[nodiscard]] TextTable allan_table(const AppliedCalibration& applied);

/// Returns the origin of the calibration, a description of the two ways, and the remarks.
[[nodiscard]] std::vector<std::string> applied_sentences(const AppliedCalibration& applied);

/// Returns tables and sentences for the terminal; empty without a calibration.
[[nodiscard]] std::string applied_text(const RecordResult& result);

/// Returns the two further cells of record.csv, each with its comma in front; the cells are empty
/// outside the analysed segment.  Returns an empty text without a calibration.
[[nodiscard]] std::string applied_cells(const RecordResult& result, UtcTime time);

/// Returns the part `applied` of result.json; null without a calibration.
[[nodiscard]] nlohmann::ordered_json applied_json(const RecordResult& result);

}  // namespace a351::corrector
