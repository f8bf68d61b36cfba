#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

struct RecordCalibrationOptions {
    std::vector<std::string> files;   ///< Same kinds as for `record`.
    std::optional<UtcTime> power_on;  ///< At most half an hour before a record begins.
    std::optional<double>
        within_mgal;  ///< Absent: 1 mGal, and a record without warm-up is no error.
};

/// Fits the two paths to every segment of the records, pools them, and adds thermal part, warm-up
/// and origin to the calibration.
/// @return  a text: the parameters found, and those not determined.
/// @throws InputError  a record cannot be read or is of another unit; the records do not determine
///                     the thermal part, or, when `within_mgal` is given, the warm-up.
[[nodiscard]] std::string calibrate_from_records(Calibration& calibration,
                                                 const RecordCalibrationOptions& options);

}  // namespace a351::corrector
