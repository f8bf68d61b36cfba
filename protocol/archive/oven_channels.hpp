#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/second_packer.hpp"
#include "protocol/oven/controller_values.hpp"

namespace a351::record {

/// Answer of the oven's controller.
struct OvenSample {
    UtcTime utc;
    oven::ControllerValues values;
    std::int64_t index = 0;  ///< Newest sample of the sensor at that time.
};

/// Makes the channels of the oven: LK2 process value, LK3 set point, both in 0.001 degC, and LYH
/// heating in 0.01 %.  Samples are `interval` apart.  An answer is taken for a place if it comes
/// less than 1 s before or after it (0.6 s at an interval of 1 s); of several answers the first one
/// counts.  After a pause the next answer begins a new row, on the nearest second.  A process value
/// is missing if the status reports an input error.
class OvenChannels {
public:
    explicit OvenChannels(std::chrono::seconds interval)
        : interval_(interval),
          temperature_(kOvenTemperature, interval),
          set_point_(kOvenSetPoint, interval),
          heating_(kOvenHeating, interval) {}

    [[nodiscard]] std::chrono::seconds interval() const noexcept { return interval_; }

    void add(const RecordContext& context, const OvenSample& sample);

    void pass(const RecordContext& context, UtcTime now);
    void close(const RecordContext& context, bool ends_series);

private:
    std::chrono::seconds interval_;
    std::optional<std::chrono::sys_seconds> newest_;
    SecondPacker temperature_, set_point_, heating_;
};

}  // namespace a351::record
