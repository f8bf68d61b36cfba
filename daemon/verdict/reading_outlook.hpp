#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "daemon/verdict/oven_filter.hpp"
#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon {

/// What temperature will do to the reading within the next 10 min.
struct Outlook {
    double change_mgal =
        0.0;                  ///< Of its mean over a cycle, where |change| + sure error is most ...
    double error_mgal = 0.0;  ///< ... with its standard error there.
};

/// The unit's response to the oven's filter.  With m the mean over one cycle, centred,
///
///     e = static m(T) + rate dm(T)/dt + slow m(lag(T)) + warm-up,
///     change(s) = e(t + s) - e(t),   0 < s <= 10 min
///
/// which needs T from half a cycle ago on, which has been seen, to half a cycle beyond s, which the
/// filter continues.  Its error joins the filter's, for now and for the noise to come, and a share of
/// what the box is off its level: the oven's cycle is not regular while it follows the air.
class ReadingOutlook {
public:
    ReadingOutlook(const VerdictOptions& options, const OvenFilter& filter);

    void clear();
    void take(double degc);  ///< The next mean, or what was expected in its place.

    /// @param filter        as it is after that mean.
    /// @param warm_up_mgal  what is left of the warm-up now.
    /// @return              std::nullopt before half a cycle.
    [[nodiscard]] std::optional<Outlook> outlook(const OvenFilter& filter,
                                                 double warm_up_mgal) const;

private:
    static constexpr std::size_t kAhead = 30;  ///< Steps: 10 min.
    static constexpr std::size_t kEvery = 3;   ///< Steps: 1 min.
    using Changes = std::array<double, kAhead / kEvery>;

    [[nodiscard]] Changes changes(const std::vector<double>& degc, double slow_degc) const;
    [[nodiscard]] std::vector<double> continued(std::vector<double> degc, OvenFilter::State state,
                                                const OvenFilter& filter) const;

    VerdictOptions options_;
    std::size_t half_;  ///< Steps of half a cycle.
    double slow_gain_;
    std::deque<double> past_degc_;
    std::deque<double> past_slow_degc_;  ///< Lagged.
    std::array<OvenFilter::State, kAhead / kEvery> by_state_{};
    Changes unforeseen_mgal2_{};  ///< Variance by the noise to come.
};

}  // namespace a351::daemon
