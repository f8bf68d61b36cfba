#pragma once
/// @file
/// How well a verdict does against the truth, by the operator's watch: a value of the live series
/// counts from the instant at which it can be seen.

#include <vector>

#include "daemon/verdict/verdict.hpp"
#include "tests/support/verdict_truth.hpp"

namespace a351::sim {

inline constexpr int kMostEarlySeconds = 60;
/// A hand that comes gently (it grows over 5 to 25 s) is not above traffic at once: what becomes
/// STABLE meanwhile, after the truth had allowed it, counts as false, not as early.
inline constexpr std::size_t kSeeSeconds = 20;

struct VerdictScore {
    int onsets = 0;               ///< STABLE was said where the truth is known.
    std::vector<double> early_s;  ///< Onsets more than 1 min before the truth allowed: when.
    std::vector<double>
        delays_s;           ///< From the truth's beginning to STABLE; infinite: not before its end.
    double stable_s = 0.0;  ///< Told STABLE, truth known ...
    double false_s = 0.0;   ///< ... and against it.

    void add(const VerdictScore& other);
    [[nodiscard]] double median_delay_s() const;
    [[nodiscard]] double false_share() const { return stable_s > 0.0 ? false_s / stable_s : 0.0; }
};

/// What was told, once a second from the start of the record; no_data before the first sample.
[[nodiscard]] std::vector<daemon::VerdictState> told(const VerdictRecord& record);

[[nodiscard]] VerdictScore score(const std::vector<daemon::VerdictState>& told,
                                 const std::vector<Allowed>& truth);

}  // namespace a351::sim
