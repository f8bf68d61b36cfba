#pragma once
/// @file
/// The result of a long record as text, tables and JSON.  Run twice, the bytes are the same.
/// Columns: corrector/methods.md, "A long record at one point".

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/long_record/apply_calibration.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// A record that was read, divided and analysed.
struct RecordResult {
    LongRecord record;
    RecordSegments parts;
    std::size_t analysed = 0;  ///< Number of the segment, the longest.
    RecordAnalysis analysis;
    RecordAnalysisOptions options;
    std::optional<AppliedCalibration> applied;  ///< To the analysed segment.

    [[nodiscard]] const RecordSegment& segment() const { return parts.segments[analysed]; }
};

/// Aligned tables: segments, statistics beside the publication's, response, reading, remarks.
[[nodiscard]] std::string record_text(const RecordResult& result);

/// A statistic with what the publication printed; a dash where it has none.
struct RecordStatistic {
    std::string key;  ///< In result.json.
    std::string name, unit, published;
    double value = 0.0;
    int decimals = 0;
};
[[nodiscard]] std::vector<RecordStatistic> record_statistics(const RecordResult& result);

/// `time_utc,acceleration_mgal,temperature_degc,segment`: every sample; empty where missing; the
/// number of its segment from 1, empty where it is in none.  With a calibration `parametric_mgal` and
/// `by_modes_mgal` follow, of the analysed segment.
[[nodiscard]] std::string record_csv(const RecordResult& result);

/// Both ways by period.
[[nodiscard]] std::string response_csv(const RecordResult& result);

/// @param settings  object with every option of the run.
[[nodiscard]] std::string record_json(const RecordResult& result,
                                      const nlohmann::ordered_json& settings);

/// record.csv, response.csv and result.json.
[[nodiscard]] std::vector<text::NamedText> record_files(const RecordResult& result,
                                                        const nlohmann::ordered_json& settings);

}  // namespace a351::corrector
