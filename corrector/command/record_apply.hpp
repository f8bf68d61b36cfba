#pragma once

#include <string>

#include "corrector/long_record/record_result.hpp"

namespace a351::corrector {

/// Applies the thermal part of a calibration to the analysed segment, and notes whether the
/// calibration was measured from this record.
/// @throws InputError  the file is not a calibration, has no thermal part, or is of another unit.
void apply_to(RecordResult& result, const std::string& file);

}  // namespace a351::corrector
