#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "protocol/oven/controller_values.hpp"
#include "protocol/record/channel_code.hpp"
#include "protocol/record/second_packer.hpp"

namespace a351::record {

/// What the oven's controller answered, at the nearest UTC second.
struct OvenSample {
    std::chrono::sys_seconds second;
    oven::ControllerValues values;
    std::int64_t index = 0;  ///< Of the newest sample of the sensor then.
};

/// LK2 process value, LK3 set point in 0.001 degC, LYH heating in 0.01 %.  Of two answers in one
/// second the later one counts, unless the second was settled between them.  A process value that
/// its status makes unbelievable is missing.
class OvenChannels {
public:
    void add(const RecordContext& context, const OvenSample& sample);

    /// No more is awaited for this second and those before.
    void settle(const RecordContext& context, std::chrono::sys_seconds second);

    void pass(const RecordContext& context, UtcTime now);
    void close(const RecordContext& context, bool ends_series);

private:
    void store(const RecordContext& context);

    std::optional<std::chrono::sys_seconds> newest_;
    std::optional<OvenSample> unsettled_;  ///< Of `newest_`.
    SecondPacker temperature_{kOvenTemperature}, set_point_{kOvenSetPoint}, heating_{kOvenHeating};
};

}  // namespace a351::record
