#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Nominal time from sample to sample.  Counted in whole seconds and a rest, so that no rounding
/// grows with the index.
class SamplePeriod {
public:
    explicit SamplePeriod(Hertz rate)
        : per_second_(std::max<std::int64_t>(1, std::llround(rate.value()))),
          second_(from_seconds(static_cast<double>(per_second_) / rate.value())) {}

    [[nodiscard]] std::int64_t per_second() const noexcept { return per_second_; }

    [[nodiscard]] Nanoseconds of(std::int64_t samples) const noexcept {
        return samples / per_second_ * second_ + samples % per_second_ * second_ / per_second_;
    }

private:
    std::int64_t per_second_;
    Nanoseconds second_;
};

}  // namespace a351::timing
