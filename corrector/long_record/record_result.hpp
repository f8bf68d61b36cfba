#pragma once
/// @file
/// The result of a long record as text, CSV and JSON.  The same input gives the same bytes.
/// Columns: corrector/long_record/long_record.md, "Files".
///
///     RecordResult result;
///     result.record = joined_record(read_records(files, window));
///     result.parts = divide_record(result.record);
///     result.analysed = number_of_longest(result.parts.segments);
///     result.analysis = analyse_record(result.segment(), result.record.step_s, result.options);
///     text::write_together(folder, record_files(result, settings));
///
/// The page with figures is make_long_record_page() of corrector/report/report.hpp.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/long_record/apply_calibration.hpp"
#include "corrector/long_record/tilt_record.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::long_record {

/// A record that was read, divided into segments and analysed.
///
/// Invariants: `analysed` is below the number of segments; `analysis` is that of this segment with
/// these options.  The members are filled in one by one, so a default-constructed result must not
/// be passed to any function here.
struct RecordResult {
    LongRecord record;
    RecordSegments parts;
    std::size_t analysed = 0;  ///< Number of the analysed segment, from 0: the longest.
    RecordAnalysis analysis;
    RecordAnalysisOptions options;
    std::optional<AppliedCalibration> applied;  ///< Calibration applied to the analysed segment.
    /// Tilt in place of the norm: then all segments are analysed, and `analysis` is empty.
    std::optional<TiltFit> tilt;

    /// Returns the analysed segment; valid as long as `parts` does not change.
    [[nodiscard]] const RecordSegment& segment() const { return parts.segments[analysed]; }
};

/// Returns the text for the terminal: segments, statistics and published values, reading, response,
/// two paths, applied calibration, remarks.  Each line ends with LF.
[[nodiscard]] std::string record_text(const RecordResult& result);

/// A statistic and the published value; a dash if there is none.
///
/// `published` is a text, because the publication gives ranges and words too.  `unit` is empty for
/// a ratio.  `value` may be NaN, for example a ratio of peaks that are 0.
struct RecordStatistic {
    std::string key;  ///< Key in result.json.
    std::string name, unit, published;
    double value = 0.0;
    int decimals = 0;  ///< Number of decimals in tables.
};
/// Returns all statistics; those of the modes only if both modes were found.  Keys are unique; they
/// begin with raw_, trend_, band_ or mode_, and end with the unit if there is one.
[[nodiscard]] std::vector<RecordStatistic> record_statistics(const RecordResult& result);

/// Returns record.csv, response.csv, and result.json, in which values that are not finite are null.
///
/// A tilt has record.csv and result.json only.
///
/// record.csv has one row per decimated sample of all stretches, response.csv one per band or mode,
/// refused ones too.  Values in CSV of the record have all digits.
/// @param result    with at least one stretch and one segment.
/// @param settings  object with every option of the run.
[[nodiscard]] std::vector<text::NamedText> record_files(const RecordResult& result,
                                                        const nlohmann::ordered_json& settings);

}  // namespace a351::corrector::long_record
