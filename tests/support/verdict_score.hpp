#pragma once
/// @file
/// Compares a verdict with the truth, in the operator's time: a value of the live series counts
/// from the time at which it can be seen.

#include <vector>

#include "daemon/verdict/verdict.hpp"
#include "tests/support/verdict_truth.hpp"

namespace a351::sim {

/// Time in s by which STABLE may come before the truth allows it.
inline constexpr int kMostEarlySeconds = 60;
/// Time in s in which a touch can stay unnoticed: a gentle one grows over 5 to 25 s and is at first
/// not stronger than traffic.  A verdict that becomes STABLE in this time after the truth last
/// allowed it counts as false, not as early.
inline constexpr std::size_t kUnnoticedSeconds = 20;

struct VerdictScore {
    int onsets = 0;  ///< Number of times the verdict became STABLE while the truth is known.
    /// Times of onsets more than 1 min before the truth allowed them.
    std::vector<double> early_s;
    /// Delays from the time at which the truth allows STABLE to the verdict; infinite: not before
    /// the truth forbids it again.
    std::vector<double> delays_s;
    double stable_s = 0.0;  ///< Time for which the verdict was STABLE and the truth is known.
    double false_s = 0.0;   ///< Part of stable_s in which the truth forbids STABLE.

    void add(const VerdictScore& other);
    [[nodiscard]] double median_delay_s() const;
    [[nodiscard]] double false_share() const { return stable_s > 0.0 ? false_s / stable_s : 0.0; }
};

/// Returns the verdict once a second from the start of the record; no_data before the first sample.
[[nodiscard]] std::vector<daemon::verdict::State> told(const VerdictRecord& record);

[[nodiscard]] VerdictScore score(const std::vector<daemon::verdict::State>& told,
                                 const std::vector<Allowed>& truth);

}  // namespace a351::sim
