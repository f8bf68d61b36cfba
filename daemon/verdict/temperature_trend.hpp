#pragma once

#include <optional>

#include "daemon/verdict/oven_filter.hpp"
#include "daemon/verdict/reading_outlook.hpp"
#include "daemon/verdict/verdict_options.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon {

/// The series of temperature as means of 20 s, each with the error that its own scatter gives it,
/// through the oven's filter.  A gap of up to 5 min is bridged by what the filter expects.
class TemperatureTrend {
public:
    explicit TemperatureTrend(const VerdictOptions& options);

    /// @param temperature  NaN: missing.  Of rising instants; anything else starts anew.
    void take(UtcTime time, DegC temperature);

    /// A hand is at the box: its lid may be open from now on.
    void touch() { filter_.touch(); }

    /// @param warm_up_mgal  what is left of the warm-up now.
    /// @return              std::nullopt until `history_min` is known.
    [[nodiscard]] std::optional<Outlook> outlook(double warm_up_mgal) const;

    [[nodiscard]] double slope_degc_per_h() const noexcept;  ///< Beneath the cycle.
    [[nodiscard]] double known_min() const noexcept;

private:
    void close_mean();
    void bridge();

    VerdictOptions options_;
    OvenFilter filter_;
    ReadingOutlook reading_;
    int means_ = 0;  ///< Seen or bridged without a break.
    UtcTime begun_;  ///< Of the mean that is gathered.
    UtcTime last_;   ///< Value.
    double last_degc_ = 0.0;
    double sum_degc_ = 0.0, squares_degc2_ = 0.0;  ///< Squares of the steps from value to value.
    int count_ = 0;
    double variance_degc2_ = 0.0;  ///< Of a value.
};

}  // namespace a351::daemon
