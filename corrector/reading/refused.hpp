#pragma once

#include <string>
#include <utility>

#include "protocol/core/input_error.hpp"

namespace a351::corrector::reading {

/// Readings that cannot be corrected, with a code that programs can read.
///
/// - no_stay: no occupation was started.
/// - no_usable_stay: every occupation is impossible, for example at a site that is not in the table.
/// - no_metadata: the station metadata cannot be read; the daemon writes them with the first data.
/// - no_reading: no occupation has enough samples for a reading yet.
/// - too_few_readings: one reading, which is compared with nothing.
/// - no_reference: no reading is at a site whose gravity is known.
/// - not_determined: the model refuses the readings for another reason.
class Refused : public InputError {
public:
    Refused(std::string code, std::string message)
        : InputError(std::move(message)), code_(std::move(code)) {}

    [[nodiscard]] const std::string& code() const noexcept { return code_; }

private:
    std::string code_;
};

}  // namespace a351::corrector::reading
