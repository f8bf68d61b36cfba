#pragma once

#include <optional>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/verdict.hpp"

namespace a351::daemon::verdict {

/// The reading of a running set-up so far.
struct RunningReading {
    std::optional<MilliGal> value;           ///< Mean of the norm; absent before the first sample.
    std::optional<MilliGal> standard_error;  ///< Absent before three whole minutes.
    double used_s = 0.0;                     ///< Length of signal used.
    double left_out_s = 0.0;                 ///< Length left out: knocks and missing samples.
    bool is_good_enough = false;  ///< The error has reached the target and the verdict is stable.
    /// Seconds of signal still needed to reach the target, 0 if reached; absent if not known.
    std::optional<double> needed_s;
};

/// The running value of one set-up: the mean of the norm, without knocks and the values that they
/// reach through the filters.  Its standard error combines the scatter of the means of whole
/// minutes with the error that an incomplete oven cycle leaves in a mean over u:
///
///     e^2 = s^2 60 s / u + (A / (2 sqrt 2) min(1, T / (pi u)))^2,   A = cycle_mgal, T = cycle_s
///
/// The error does not include the placement of the box, which shows only between set-ups.
class RunningValue {
public:
    /// Values that depend on samples before `start` are not used.
    RunningValue(const Options& options, UtcTime start) : options_(options), start_(start) {}

    void take(const LiveSample& sample);

    /// Returns the reading so far.  @param target  > 0
    [[nodiscard]] RunningReading reading(MilliGal target, State state) const;

private:
    Options options_;
    UtcTime start_;
    std::optional<UtcTime> last_shaken_;
    double zero_mgal_ = 0.0;  ///< First value; sums are of differences from it.
    double sum_mgal_ = 0.0;
    int used_ = 0, left_out_ = 0;
    double minute_sum_mgal_ = 0.0;
    int in_minute_ = 0;
    int minutes_ = 0;
    double minutes_sum_ = 0.0, minutes_square_ = 0.0;
};

}  // namespace a351::daemon::verdict
