#pragma once
/// @file
/// Samples on a regular axis of time: start, rate, unit and values in one object.
///
/// Use it where the rate is constant and every sample has its place, also a missing one.  Do not
/// use it where each sample has a time stamp of its own, or across a jump of the clock.  A series
/// of another unit, or one without a rate, does not compile (tests/compile_fail).
///
///     const TimeSeries<DegC> series(start, Hertz(50.0), {20.0, 20.1});
///     series[1];             // DegC(20.1)
///     series.time_of(50.0);  // start + 1 s, beyond the last sample

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351 {

/// Samples at a constant rate, in one unit.  A missing or invalid sample is NaN.
///
/// The object owns its samples.  Only an assignment or a move changes it, so any number of threads
/// may read it.  A copy copies all samples; a move does not.
/// @tparam Unit  a Quantity of units.hpp, for example MilliGal.
template <class Unit>
class TimeSeries {
public:
    /// Takes the samples.
    /// @param start   time of sample 0.
    /// @param rate    samples per second, > 0.
    /// @param values  (n), numbers in `Unit`, NaN where missing; n = 0 is allowed.  They are not
    ///                checked.
    /// @throws std::invalid_argument  rate not positive.  This includes NaN.
    TimeSeries(UtcTime start, Hertz rate, std::vector<double> values)
        : start_(start), rate_(rate), values_(std::move(values)) {
        if (!(rate.value() > 0.0)) throw std::invalid_argument("TimeSeries: rate must be > 0 Hz");
    }

    /// Returns the time of sample 0, also if the series is empty.
    [[nodiscard]] UtcTime start() const noexcept { return start_; }
    /// Returns the samples per second; their period is 1 / rate().
    [[nodiscard]] Hertz rate() const noexcept { return rate_; }
    /// Returns the number n of samples; missing ones count.
    [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }
    /// Returns the samples (n) as plain numbers in `Unit`.  The reference is valid until the series
    /// ends or is assigned to.
    [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }
    /// Returns sample i with its unit.
    /// @param i  less than size(); not checked.
    [[nodiscard]] Unit operator[](std::size_t i) const { return Unit(values_[i]); }
    /// Returns the time of sample i to 1 ns; i may be a fraction or lie outside the series.
    ///
    ///     start + i / rate
    ///
    /// The error does not add up from sample to sample.  The limits of from_seconds() apply:
    /// beyond 52 days from the start the result can be wrong by a few nanoseconds.
    /// @param i  finite, and |i / rate| below 9e9 s; not checked.
    [[nodiscard]] UtcTime time_of(double i) const {
        return start_ + from_seconds(i / rate_.value());
    }

private:
    UtcTime start_;
    Hertz rate_;
    std::vector<double> values_;
};

}  // namespace a351
