#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "daemon/verdict/oven_filter.hpp"
#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon::verdict {

/// The effect of temperature on the reading within the next 10 min.
struct Outlook {
    /// Change of the reading's mean over a cycle, when |change| + sure error is largest.
    double change_mgal = 0.0;
    double error_mgal = 0.0;  ///< Standard error of this change.
};

/// Predicts the reading from the oven's filter with the unit's temperature response.  With m the
/// centred mean over one cycle,
///
///     e = static m(T) + rate dm(T)/dt + slow m(lag(T)) + warm-up,
///     change(s) = e(t + s) - e(t),   0 < s <= 10 min
///
/// This needs T from half a cycle ago, which was observed, to half a cycle after s, which the
/// filter predicts.  The error combines the filter's present error, its future noise, and a share
/// of the distance of the box from its level, because the oven's cycle is irregular while it
/// follows the air.
class ReadingOutlook {
public:
    ReadingOutlook(const Options& options, const OvenFilter& filter);

    void clear();
    void take(double degc);  ///< Takes the next mean, or the expected value in its place.

    /// Returns the outlook from now on.
    /// @param filter        its state after the last mean.
    /// @param warm_up_mgal  remaining effect of the warm-up now.
    /// @return              std::nullopt before half a cycle is known.
    [[nodiscard]] std::optional<Outlook> outlook(const OvenFilter& filter,
                                                 double warm_up_mgal) const;

private:
    static constexpr std::size_t kAhead = 30;  ///< Steps: 10 min.
    static constexpr std::size_t kEvery = 3;   ///< Steps: 1 min.
    using Changes = std::array<double, kAhead / kEvery>;

    [[nodiscard]] Changes changes(const std::vector<double>& degc, double slow_degc) const;
    [[nodiscard]] std::vector<double> continued(std::vector<double> degc, OvenFilter::State state,
                                                const OvenFilter& filter) const;

    Options options_;
    std::size_t half_;  ///< Number of steps in half a cycle.
    double slow_gain_;
    std::deque<double> past_degc_;
    std::deque<double> past_slow_degc_;  ///< Lagged temperatures.
    std::array<OvenFilter::State, kAhead / kEvery> by_state_{};
    Changes unforeseen_mgal2_{};  ///< Variance due to future noise.
};

}  // namespace a351::daemon::verdict
