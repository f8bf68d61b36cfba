#pragma once
/// @file
/// Effect of an applied calibration as table cells, text and JSON.
///
/// Every table compares three columns: before, parametric, by modes (apply_calibration.hpp).  The
/// first row is the header.  Cells are plain text with three decimals.
///
/// Functions of an AppliedCalibration need one.  Those of a RecordResult may be called without one.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/long_record/record_tables.hpp"

namespace a351::corrector::long_record {

/// Returns the scatter by period band, before and after, mGal.  One row per band, the fastest
/// first; the last band has no upper limit.
[[nodiscard]] TextTable applied_bands_table(const AppliedCalibration& applied);
/// Returns the Allan deviations by averaging time, before and after, mGal.  The averaging time
/// doubles from row to row.
[[nodiscard]] TextTable allan_table(const AppliedCalibration& applied);

/// Returns the origin of the calibration, a description of the two ways, and the remarks.  They are
/// plain text without full stop or line end.
[[nodiscard]] std::vector<std::string> applied_sentences(const AppliedCalibration& applied);

/// Returns tables and sentences for the terminal; empty without a calibration.  An empty line is at
/// the end.
[[nodiscard]] std::string applied_text(const RecordResult& result);

/// Returns the two further cells of record.csv, each with its comma in front; the cells are empty
/// outside the analysed segment.  Returns an empty text without a calibration.
/// @param time  of the row; the sample of the segment nearest to it is taken.
[[nodiscard]] std::string applied_cells(const RecordResult& result, UtcTime time);

/// Returns the part `applied` of result.json; null without a calibration.
///
/// Keys: calibration, averaged_below_s, bands, allan, remarks.  Numbers have all digits.  The upper
/// limit of the last band is infinite, which is null in the written JSON.
[[nodiscard]] nlohmann::ordered_json applied_json(const RecordResult& result);

}  // namespace a351::corrector::long_record
