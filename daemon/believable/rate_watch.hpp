#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::believable {

/// Watches the rate at which samples arrive.  The sample clock does not: it only follows rates near the
/// nominal one.
///
/// A delay makes samples arrive later, not earlier, so the least lag of a block of 8 s has nearly no
/// delay in it:
///
///     lag = arrival - index / nominal rate,   rate = nominal rate x (1 - lag gained / time)
///
/// The rate is wrong if it is farther than kMostRateError from the nominal one over seven blocks, and
/// each of them gained at least half of its share.  So a stall of any length is not a rate.
class RateWatch {
public:
    /// @param rate_hz  nominal rate, > 0
    explicit RateWatch(int rate_hz) : rate_hz_(rate_hz) {}

    /// Takes the newest sample that has arrived.  After a gap of a block the watch begins again.
    /// @param index  in the session; lost samples are counted
    void take(std::int64_t index, RawTime arrival);

    /// Returns the rate if it is wrong.
    [[nodiscard]] std::optional<Hertz> wrong_rate() const;

private:
    struct Arrival {
        std::int64_t index = 0;
        RawTime time;
    };
    int rate_hz_;
    std::optional<Arrival> first_;
    RawTime block_begin_, last_;
    std::optional<double> least_lag_s_;  ///< Least lag in the open block.
    std::deque<double> lags_s_;          ///< Least lags of complete blocks.
};

[[nodiscard]] text::Message rate_trouble(Hertz wrong_rate, int output_rate_hz);

}  // namespace a351::daemon::believable
