#pragma once

#include <deque>
#include <optional>

#include "daemon/verdict/verdict_options.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon {

struct Slope {
    double mgal_per_h = 0.0;
    double error_mgal_per_h = 0.0;  ///< Standard error.
};

/// How the reading moves beneath the oven's cycle, at one place: a, b, c, d by least squares to the
/// means of whole minutes of the last 40,
///
///     a + b t + c cos(w t) + d sin(w t),   w = 2 pi / cycle_s
///
/// The error of b takes neighbouring residuals as related: first-order autoregressive.
class ReadingSlope {
public:
    explicit ReadingSlope(const VerdictOptions& options) : options_(options) {}

    /// @param norm  of the axes; nothing of a knock in it.
    void take(UtcTime time, MilliGal norm);
    void clear();  ///< Another place.

    /// std::nullopt until `history_min` is known.
    [[nodiscard]] const std::optional<Slope>& slope() const noexcept { return slope_; }

private:
    struct Minute {
        UtcTime time;
        double mgal = 0.0;  ///< Above zero_mgal_.
    };

    void close_minute();
    [[nodiscard]] std::optional<Slope> fit() const;

    VerdictOptions options_;
    std::deque<Minute> minutes_;
    UtcTime begun_;
    double zero_mgal_ = 0.0, sum_mgal_ = 0.0;
    int count_ = 0;
    std::optional<Slope> slope_;
};

}  // namespace a351::daemon
