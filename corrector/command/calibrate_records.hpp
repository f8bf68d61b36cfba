#pragma once
/// @file
/// `calibrate FILE...`: the thermal part and the warm-up of a calibration, from long records.
///
/// The steps are those of corrector/long_record/long_record.md, "Calibration".  Records are read
/// and joined, divided into segments, and fitted; then the fits are combined.
///
///     Calibration calibration;
///     std::cout << calibrate_from_records(calibration, {.files = {"data"}});
///
/// Axis biases, if they are measured too, are measured before: both parts must be of one unit.

#include <optional>
#include <string>
#include <vector>

#include "protocol/unit/calibration.hpp"

namespace a351::corrector::command {

/// Options of calibrate_from_records().
///
/// `within_mgal` is the limit of WarmUpGuidance, mGal, > 0.  If it is given, a warm-up is wanted,
/// and records that do not determine one are an error.  Without `power_on` there is no warm-up.
struct RecordCalibrationOptions {
    std::vector<std::string> files;   ///< Same kinds as for `record`.
    std::optional<UtcTime> power_on;  ///< At most half an hour before a record begins.
    std::optional<double>
        within_mgal;  ///< Absent: 1 mGal, and a record without warm-up is no error.
};

/// Fits the two paths to every segment of the records, pools them, and adds thermal part, warm-up
/// and origin to the calibration.
///
/// - A segment that shows no response to temperature, or is too short, is left out and named in the
///   text.
/// - A segment that begins within half an hour after power-on loses its first 4 h for the thermal
///   part, because the fit assumes equilibrium.  The whole of it serves the warm-up.
/// - Records that contradict each other at 1 % are reported in the text; the result is then
///   doubtful.
///
/// Progress and warnings go to standard error.  After an exception the calibration may have the
/// origin of the new records, so it must not be used.
/// @param calibration  receives `thermal` and `warm_up`; other parts are kept.
/// @param options      at least one file.
/// @return  a text: the parameters found, and those not determined.
/// @throws InputError  a record cannot be read or is of another unit; the records do not determine
///                     the thermal part, or, when `within_mgal` is given, the warm-up.
[[nodiscard]] std::string calibrate_from_records(unit::Calibration& calibration,
                                                 const RecordCalibrationOptions& options);

}  // namespace a351::corrector::command
