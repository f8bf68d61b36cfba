#pragma once

#include <optional>

#include "daemon/verdict/oven_filter.hpp"
#include "daemon/verdict/reading_outlook.hpp"
#include "daemon/verdict/verdict_options.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::verdict {

/// Passes the temperature as means of 20 s of UTC, each with an error from its own scatter, through
/// the oven's filter.  A gap of up to 5 min is filled with the values that the filter expects.
class TemperatureTrend {
public:
    explicit TemperatureTrend(const Options& options)
        : options_(options), filter_(options), reading_(options, filter_) {}

    /// Takes a value.  Times must increase; otherwise the trend starts again.
    /// @param temperature  NaN if missing.
    void take(UtcTime time, DegC temperature);

    /// Notes that the box is being handled: its lid may be open from now on.
    void touch() { filter_.touch(); }

    /// Returns the outlook of the reading.
    /// @param warm_up_mgal  remaining effect of the warm-up now.
    /// @return              std::nullopt until `history_min` minutes are known.
    [[nodiscard]] std::optional<Outlook> outlook(double warm_up_mgal) const;

    /// Returns the slope without the oven's cycle.
    [[nodiscard]] double slope_degc_per_h() const noexcept;
    /// Returns the time for which the temperature is known without a break, min.
    [[nodiscard]] double known_min() const noexcept;

private:
    void close_mean();

    Options options_;
    OvenFilter filter_;
    ReadingOutlook reading_;
    int means_ = 0;  ///< Means observed or filled without a break.
    UtcTime begun_;  ///< Start of the mean in progress.
    UtcTime last_;   ///< Time of the last value.
    double last_degc_ = 0.0;
    double sum_degc_ = 0.0, squares_degc2_ = 0.0;  ///< Squares of the steps between values.
    int count_ = 0;
    double variance_degc2_ = 0.0;  ///< Variance of one value.
};

}  // namespace a351::daemon::verdict
