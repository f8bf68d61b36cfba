#pragma once

#include <array>
#include <optional>
#include <vector>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon::verdict {

/// The reading of one or several set-ups so far.
struct RunningReading {
    /// Mean of the norm, of several set-ups the mean of their means; absent before the first sample.
    std::optional<MilliGal> value;
    int set_ups = 0;                    ///< Number of set-ups in the mean.
    std::optional<MilliGal> set_up_sd;  ///< Standard deviation of their means, from two on.
    /// Limits of their true scatter with 95 % confidence, if it is normal.
    std::optional<std::array<MilliGal, 2>> set_up_sd_limits;
    std::optional<MilliGal> set_up_error;  ///< This, divided by the root of their number.
    double used_s = 0.0;                   ///< Length of signal used.
    double left_out_s = 0.0;               ///< Length left out: knocks and missing samples.
};

/// The running value of the set-ups of a stay: the mean of the norm, without knocks and the values
/// that they reach through the filters.  A further set-up is in the mean after its first whole minute.
/// It is not corrected for anything, so it has no error that means one of gravity.
class RunningValue {
public:
    explicit RunningValue(const Options& options) : options_(options) {}

    /// Begins a set-up; the first one before any sample.  Values that depend on samples before
    /// `start` are not used.
    void begin_set_up(UtcTime start);

    void take(const LiveSample& sample);

    /// Returns the reading so far.
    [[nodiscard]] RunningReading reading() const;

private:
    struct SetUp {
        UtcTime start;
        double zero_mgal = 0.0;  ///< First value; sums are of differences from it.
        double sum_mgal = 0.0;
        int used = 0, left_out = 0;
    };

    Options options_;
    std::vector<SetUp> set_ups_;
    std::optional<UtcTime> last_shaken_;
};

}  // namespace a351::daemon::verdict
