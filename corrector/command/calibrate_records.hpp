#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

struct RecordCalibrationOptions {
    std::vector<std::string> files;     ///< As of `record`.
    std::optional<UtcTime> power_on;    ///< Shortly before the first record begins.
    std::optional<double> within_mgal;  ///< Absent: the usual, and no warm-up is no error.
};

/// Fits the two paths to every segment of the records, pools them, and adds thermal part, warm-up and
/// origin to the calibration.
/// @return  in words, what was found and what was left open.
/// @throws InputError  a record cannot be read, is of another unit, or tells nothing of the thermal
///                     part; of the warm-up, when `within_mgal` is given.
[[nodiscard]] std::string calibrate_from_records(Calibration& calibration,
                                                 const RecordCalibrationOptions& options);

}  // namespace a351::corrector
