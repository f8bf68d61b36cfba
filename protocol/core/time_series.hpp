#pragma once

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351 {

/// Samples at a constant rate, in one unit.  A missing or invalid sample is NaN.
template <class Unit>
class TimeSeries {
public:
    /// @throws std::invalid_argument  rate not positive.
    TimeSeries(UtcTime start, Hertz rate, std::vector<double> values)
        : start_(start), rate_(rate), values_(std::move(values)) {
        if (!(rate.value() > 0.0)) throw std::invalid_argument("TimeSeries: rate must be > 0 Hz");
    }

    [[nodiscard]] UtcTime start() const noexcept { return start_; }
    [[nodiscard]] Hertz rate() const noexcept { return rate_; }
    [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }
    [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }
    [[nodiscard]] Unit operator[](std::size_t i) const { return Unit(values_[i]); }
    /// Returns the time of sample i to 1 ns; i may be a fraction or lie outside the series.
    [[nodiscard]] UtcTime time_of(double i) const {
        return start_ + from_seconds(i / rate_.value());
    }

private:
    UtcTime start_;
    Hertz rate_;
    std::vector<double> values_;
};

}  // namespace a351
