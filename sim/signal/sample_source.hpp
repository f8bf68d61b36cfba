#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/core/utc_time.hpp"

namespace a351::sim {

/// One sample as the device counts it.
struct SensorSample {
    std::array<std::int32_t, 3> axes_counts{};  ///< x, y, z.
    std::int32_t temperature_counts = 0;

    bool operator==(const SensorSample&) const = default;
};

struct TimedSample {
    UtcTime instant;         ///< At which the device took it, by the scenario's clock.
    std::int64_t index = 0;  ///< On the source's grid; where it jumps, samples are missing.
    SensorSample values;
};

/// Where an emulated sensor takes its samples from: a scenario, or a recording.
class SampleSource {
public:
    virtual ~SampleSource() = default;

    [[nodiscard]] virtual int rate_hz() const noexcept = 0;

    /// Of the sample that next() would give; std::nullopt after the last.
    [[nodiscard]] virtual std::optional<UtcTime> next_instant() const = 0;

    /// The samples in order.  Precondition: next_instant() has a value.
    [[nodiscard]] virtual TimedSample next() = 0;
};

}  // namespace a351::sim
