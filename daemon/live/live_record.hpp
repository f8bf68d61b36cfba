#pragma once
/// @file
/// The last day as the page draws it and the verdict judges it.  Written by the archive thread,
/// read by the page's.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "daemon/live/history.hpp"
#include "daemon/live/level.hpp"
#include "daemon/live/live_thinning.hpp"
#include "daemon/live/recent_samples.hpp"
#include "daemon/verdict/running_value.hpp"
#include "daemon/verdict/verdict.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon {

/// What the oven's controller said.
struct OvenPoint {
    UtcTime time;
    std::optional<DegC> process_value;
    DegC set_point;
};

/// std::nullopt unless the poll was answered.
[[nodiscard]] std::optional<OvenPoint> oven_point(const record::OvenChunk& poll, UtcTime time);

/// Thread-safe.  Memory: 24 h of envelopes and of the 2 s series, 90 s and more at full rate; 7 MB at
/// 50 Hz.
class LiveRecord {
public:
    /// `profile` must outlive this.
    LiveRecord(const wire::DeviceProfile& profile, int rate_hz, const VerdictOptions& options);

    /// Samples in the order of their time.  One that is earlier than the last was placed by a clock
    /// that was set back: what was remembered from there on is forgotten.
    void take(const PlacedSample& sample);
    void take(const OvenPoint& point);

    /// What came so far is the archive's past: the samples with which a replay tells it again are
    /// passed over, up to the first new one.
    void past_is_told();

    /// @name Of RecentSamples and History.
    /// @{
    [[nodiscard]] std::uint64_t end() const;
    [[nodiscard]] std::optional<LiveBlock> block_from(std::uint64_t& cursor,
                                                      std::size_t most) const;
    [[nodiscard]] std::vector<LiveEnvelope> history(LiveChannel channel, UtcTime from, UtcTime to,
                                                    std::size_t points) const;
    /// @}
    /// Every n-th, so that at most `points` (>= 1) remain.
    [[nodiscard]] std::vector<OvenPoint> oven_history(UtcTime from, UtcTime to,
                                                      std::size_t points) const;

    /// By other thresholds from now on, what is remembered judged anew.
    void judge_by(const VerdictOptions& options);

    /// What is to be told now, be there samples or not.
    [[nodiscard]] Verdict verdict(UtcTime now) const;

    /// Of the set-up from `from` to `to`, as far as it is remembered; nothing from outside enters.
    [[nodiscard]] RunningReading reading(UtcTime from, UtcTime to, MilliGal target) const;

    /// The box as it stood in the last 2 s, against the median of a set-up, to which also belongs
    /// how the box was lifted at its end; std::nullopt where one of the two is not known.
    [[nodiscard]] std::optional<Level> level_against(UtcTime from, UtcTime to) const;

    [[nodiscard]] const wire::DeviceProfile& profile() const noexcept { return profile_; }
    [[nodiscard]] int rate_hz() const noexcept { return rate_hz_; }

private:
    void forget_from(UtcTime time);
    void judge_anew();

    const wire::DeviceProfile& profile_;
    int rate_hz_;
    VerdictOptions options_;
    mutable std::mutex mutex_;
    RecentSamples recent_;
    History history_;
    LiveThinning thinning_;
    VerdictJudge judge_;
    std::vector<LiveSample> fresh_;  ///< Kept for reuse.
    std::deque<LiveSample> thinned_;
    std::deque<OvenPoint> oven_;
    std::optional<UtcTime> last_;
    std::optional<UtcTime> told_until_;  ///< Set while a replay may tell the past again.
};

}  // namespace a351::daemon
