#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/core/utc_time.hpp"

namespace a351::sim::signal {

/// One sample in counts of the device.
struct SensorSample {
    std::array<std::int32_t, 3> axes_counts{};  ///< x, y, z.
    std::int32_t temperature_counts = 0;

    bool operator==(const SensorSample&) const = default;
};

struct TimedSample {
    UtcTime instant;         ///< Instant at which the device took it, by the scenario's clock.
    std::int64_t index = 0;  ///< Index on the source's grid; a jump means missing samples.
    SensorSample values;
};

/// Source of an emulated sensor's samples: a scenario or a recording.
class SampleSource {
public:
    virtual ~SampleSource() = default;

    [[nodiscard]] virtual int rate_hz() const noexcept = 0;

    /// Returns the instant of the sample that next() would return; std::nullopt after the last.
    [[nodiscard]] virtual std::optional<UtcTime> next_instant() const = 0;

    /// Returns the samples one after the other.  Precondition: next_instant() has a value.
    [[nodiscard]] virtual TimedSample next() = 0;
};

}  // namespace a351::sim::signal
