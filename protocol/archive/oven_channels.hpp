#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "protocol/archive/channel_code.hpp"
#include "protocol/archive/second_packer.hpp"
#include "protocol/oven/controller_values.hpp"

namespace a351::record {

/// What the oven's controller answered.
struct OvenSample {
    UtcTime utc;
    oven::ControllerValues values;
    std::int64_t index = 0;  ///< Of the newest sample of the sensor then.
};

/// LK2 process value, LK3 set point in 0.001 degC, LYH heating in 0.01 %.  Samples are `interval`
/// apart; one that comes less than 1 s beside its place, or 0.6 s at an interval of 1 s, stands on
/// it.  Of several answers for a place the first one counts; after a pause the next one begins a new
/// row, on the nearest second.  A process value that its status makes unbelievable is missing.
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
