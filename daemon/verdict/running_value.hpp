#pragma once

#include <optional>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/verdict.hpp"

namespace a351::daemon {

/// An occupation as far as it has come.
struct RunningReading {
    std::optional<MilliGal> value;           ///< Mean of the norm; absent before the first sample.
    std::optional<MilliGal> standard_error;  ///< Absent before three whole minutes.
    double used_s = 0.0;                     ///< Of signal in it ...
    double left_out_s = 0.0;                 ///< ... and left out: knocks and what is missing.
    bool is_good_enough = false;  ///< The error is below the target and the verdict stable.
    /// Until the error is; absent unless it can be told.  0 when it is.
    std::optional<double> needed_s;
};

/// The running value of one set-up: the mean of the norm, knocks cut out with what they reach.  Its
/// standard error joins the scatter of the means of whole minutes with what a part of the oven's
/// cycle leaves in a mean over u:
///
///     e^2 = s^2 60 s / u + (A / (2 sqrt 2) min(1, T / (pi u)))^2,   A = cycle_mgal, T = cycle_s
///
/// How the box stands (placement) is not in it: that shows only from one set-up to the next.
class RunningValue {
public:
    /// Nothing from before `start` enters.
    RunningValue(const VerdictOptions& options, UtcTime start);

    void take(const LiveSample& sample);

    /// @param target  > 0
    [[nodiscard]] RunningReading reading(MilliGal target, VerdictState state) const;

private:
    [[nodiscard]] std::optional<double> minute_variance() const;

    VerdictOptions options_;
    UtcTime start_;
    std::optional<UtcTime> last_shaken_;
    double zero_mgal_ = 0.0;  ///< The first value; sums are of differences from it.
    double sum_mgal_ = 0.0;
    int used_ = 0, left_out_ = 0;
    double minute_sum_mgal_ = 0.0;
    int in_minute_ = 0;
    int minutes_ = 0;
    double minutes_sum_ = 0.0, minutes_square_ = 0.0;
};

}  // namespace a351::daemon
