#pragma once

#include <deque>
#include <optional>

#include "daemon/verdict/verdict_options.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::verdict {

/// Slope of the reading in time.
struct Slope {
    double mgal_per_h = 0.0;
    double error_mgal_per_h = 0.0;  ///< Standard error.
};

/// The slope b of the reading without the oven's cycle, at one place: a, b, c, d are fitted by
/// least squares to the means of the last 40 whole minutes (or `history_min`, if that is more),
///
///     a + b t + c cos(w t) + d sin(w t),   w = 2 pi / cycle_s
///
/// The reading is in mGal, t in h, b in mGal/h.  The standard error of b assumes correlated
/// residuals: first-order autoregressive.  A minute with too few values is skipped.
class ReadingSlope {
public:
    explicit ReadingSlope(const Options& options) : options_(options) {}

    /// Takes the next value.  @param norm  of the axes, not affected by a knock.
    void take(UtcTime time, MilliGal norm);
    void clear();  ///< Starts again, at another place.

    /// Returns the slope; std::nullopt until `history_min` minutes are known.
    [[nodiscard]] const std::optional<Slope>& slope() const noexcept { return slope_; }

private:
    struct Minute {
        UtcTime time;
        double mgal = 0.0;  ///< Mean, relative to zero_mgal_.
    };

    void close_minute();
    [[nodiscard]] std::optional<Slope> fit() const;

    Options options_;
    std::deque<Minute> minutes_;
    UtcTime begun_;
    double zero_mgal_ = 0.0, sum_mgal_ = 0.0;
    int count_ = 0;
    std::optional<Slope> slope_;
};

}  // namespace a351::daemon::verdict
