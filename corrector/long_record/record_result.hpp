#pragma once
/// @file
/// The result of a long record as text, CSV and JSON.  The same input gives the same bytes.
/// Columns: corrector/long_record/long_record.md, "Files".

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/long_record/apply_calibration.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// A record that was read, divided into segments and analysed.
struct RecordResult {
    LongRecord record;
    RecordSegments parts;
    std::size_t analysed = 0;  ///< Number of the analysed segment, from 0: the longest.
    RecordAnalysis analysis;
    RecordAnalysisOptions options;
    std::optional<AppliedCalibration> applied;  ///< Calibration applied to the analysed segment.

    /// Returns the analysed segment.
    [[nodiscard]] const RecordSegment& segment() const { return parts.segments[analysed]; }
};

/// Returns the text for the terminal: segments, statistics and published values, reading, response,
/// two paths, applied calibration, remarks.
[[nodiscard]] std::string record_text(const RecordResult& result);

/// A statistic and the published value; a dash if there is none.
struct RecordStatistic {
    std::string key;  ///< Key in result.json.
    std::string name, unit, published;
    double value = 0.0;
    int decimals = 0;  ///< Number of decimals in tables.
};
/// Returns all statistics; those of the modes only if both modes were found.
[[nodiscard]] std::vector<RecordStatistic> record_statistics(const RecordResult& result);

/// Returns record.csv, response.csv, and result.json, in which values that are not finite are null.
/// @param settings  object with every option of the run.
[[nodiscard]] std::vector<text::NamedText> record_files(const RecordResult& result,
                                                        const nlohmann::ordered_json& settings);

}  // namespace a351::corrector
