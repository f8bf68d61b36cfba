#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Nominal time from sample to sample.  Times are counted in seconds of data (as many samples as
/// the rate, rounded) and a rest, so that for whole rates no rounding grows with the index.
class SamplePeriod {
public:
    /// @param rate  nominal output rate, > 0; not checked.
    explicit SamplePeriod(Hertz rate)
        : per_second_(std::max<std::int64_t>(1, std::llround(rate.value()))),
          second_(from_seconds(static_cast<double>(per_second_) / rate.value())) {}

    /// Returns the rate in samples per second, rounded to a whole number, at least 1.
    [[nodiscard]] std::int64_t per_second() const noexcept { return per_second_; }

    /// Returns the nominal duration of `samples` sample periods; `samples` may be negative.
    ///
    /// Accuracy: 1 ns for a whole rate, else 1 ns + 1e-9 of the duration.
    [[nodiscard]] Nanoseconds of(std::int64_t samples) const noexcept {
        return samples / per_second_ * second_ + samples % per_second_ * second_ / per_second_;
    }

private:
    std::int64_t per_second_;
    Nanoseconds second_;
};

}  // namespace a351::timing
