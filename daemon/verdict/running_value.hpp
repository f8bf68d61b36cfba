#pragma once

#include <array>
#include <optional>
#include <vector>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/verdict.hpp"

namespace a351::daemon::verdict {

/// The reading of one or several set-ups so far.
struct RunningReading {
    /// Mean of the norm, of several set-ups the mean of their means; absent before the first sample.
    std::optional<MilliGal> value;
    std::optional<MilliGal> standard_error;  ///< Absent before three whole minutes.
    int set_ups = 0;                         ///< Number of set-ups in the mean.
    std::optional<MilliGal> set_up_sd;       ///< Standard deviation of their means, from two on.
    /// Limits of their true scatter with 95 % confidence, if it is normal.
    std::optional<std::array<MilliGal, 2>> set_up_sd_limits;
    std::optional<MilliGal> set_up_error;    ///< This, divided by the root of their number.
    double used_s = 0.0;                     ///< Length of signal used.
    double left_out_s = 0.0;                 ///< Length left out: knocks and missing samples.
    bool is_good_enough = false;  ///< The error has reached the target and the verdict is stable.
    /// Seconds of signal that the last set-up still needs to reach the target, 0 if reached; absent
    /// if not known, or if this set-up alone cannot reach it.
    std::optional<double> needed_s;
};

/// The running value of the set-ups of a stay: the mean of the norm, without knocks and the values
/// that they reach through the filters.  Its standard error combines the scatter s of the means of
/// whole minutes about the mean of their set-up with the error that an incomplete oven cycle leaves
/// in a mean over u:
///
///     e^2 = s^2 60 s / u + (A / (2 sqrt 2) min(1, T / (pi u)))^2,   A = cycle_mgal, T = cycle_s
///     1 / u = (1 / u_1 + ... + 1 / u_n) / n^2,   u_i = length of signal of set-up i
///
/// u is the sum of equal u_i.  A further set-up is in the mean after its first whole minute.
/// The error does not include the placement of the box, which shows only between set-ups.
class RunningValue {
public:
    explicit RunningValue(const Options& options) : options_(options) {}

    /// Begins a set-up; the first one before any sample.  Values that depend on samples before
    /// `start` are not used.
    void begin_set_up(UtcTime start);

    void take(const LiveSample& sample);

    /// Returns the reading so far.  @param target  > 0
    [[nodiscard]] RunningReading reading(MilliGal target, State state) const;

private:
    struct SetUp {
        UtcTime start;
        double zero_mgal = 0.0;  ///< First value; sums are of differences from it.
        double sum_mgal = 0.0;
        int used = 0, left_out = 0;
        double minute_sum_mgal = 0.0;
        int in_minute = 0;
        int minutes = 0;
        double minutes_sum = 0.0, minutes_square = 0.0;
    };

    Options options_;
    std::vector<SetUp> set_ups_;
    std::optional<UtcTime> last_shaken_;
};

}  // namespace a351::daemon::verdict
