#pragma once

#include <optional>

#include "daemon/status/status.hpp"
#include "protocol/timing/clock_reading.hpp"
#include "protocol/timing/utc_mapping.hpp"

namespace a351::daemon::store {

/// Notices steps of the host's clock that the sample times follow, by the rules of SampleClock.
class ClockWatch {
public:
    /// Takes the next reading, of the same boot of the host.
    /// @return  the step, if the times follow one from this reading on.  A leap second is none.
    std::optional<status::ClockStep> observe(const timing::ClockReading& reading);

private:
    timing::UtcMapping mapping_;
    std::optional<timing::ClockReading> last_;
    Nanoseconds slept_{0};
};

}  // namespace a351::daemon::store
