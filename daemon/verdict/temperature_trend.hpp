#pragma once

#include <deque>
#include <optional>

#include "daemon/verdict/verdict_options.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon {

/// Where the temperature goes beneath the oven's cycle, and what that will do to the reading.
struct TemperatureOutlook {
    double slope_degc_per_h = 0.0;
    double curvature_degc_per_h2 = 0.0;
    double bend_degc = 0.0;    ///< Mean of the last 3 min less the course before, continued.
    double change_mgal = 0.0;  ///< Of the reading within the next 10 min, the farthest.
};

/// Fits, by least squares, to 20 s means of the last `history_min`
///
///     T(t) = a + b t + c t^2 / 2 + d cos(w t) + e sin(w t),   w = 2 pi / cycle_s,   t = 0 now
///
/// and puts T - d cos - e sin, continued for 10 min, through the unit's response.
class TemperatureTrend {
public:
    explicit TemperatureTrend(const VerdictOptions& options);

    /// @param temperature  NaN: missing.  Of rising instants; anything else starts anew.
    void take(UtcTime time, DegC temperature);
    void clear();

    /// std::nullopt until `history_min` is there, nearly without gaps.
    [[nodiscard]] const std::optional<TemperatureOutlook>& outlook() const noexcept {
        return outlook_;
    }
    [[nodiscard]] double known_min()
        const noexcept;  ///< Length of the history, at most what it needs.

private:
    struct Mean {
        UtcTime time;
        double degc = 0.0;
    };

    void close_mean();
    [[nodiscard]] std::optional<TemperatureOutlook> fit() const;

    VerdictOptions options_;
    std::deque<Mean> means_;
    UtcTime begun_;
    double sum_degc_ = 0.0;
    int count_ = 0;
    std::optional<double> slow_degc_;  ///< Lagged temperature.
    std::optional<TemperatureOutlook> outlook_;
};

}  // namespace a351::daemon
