#pragma once
/// @file
/// The last day of data for the charts of the page and for the verdict.  The archive thread
/// writes it, the page's thread reads it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/believable/watch.hpp"
#include "daemon/live/history.hpp"
#include "daemon/live/live_thinning.hpp"
#include "daemon/verdict/running_value.hpp"
#include "daemon/verdict/verdict.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/signal/moved_box.hpp"
#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::live {

/// One answer of an oven's controller.
struct OvenPoint {
    UtcTime time;
    std::optional<DegC> process_value;
    DegC set_point;
    journal::OvenPlace place = journal::OvenPlace::inner;
};

/// Converts a poll of an oven; std::nullopt unless it was answered.
[[nodiscard]] std::optional<OvenPoint> oven_point(const journal::OvenChunk& poll, UtcTime time);

/// The tilt of the box relative to the day's first set-up.  If the horizontal axes read the same at
/// each set-up, level or not, the effect of their biases on the norm is the same everywhere.
///
///     tilt = asin(a) - asin(reference)
///
/// An axis at rest that points up reads +1 g, so its reading in g is the sine of its elevation.
/// For a sensor of opposite sign the advice reverses.  The vertical axis is the one that read most at
/// the first set-up, so the sensor may be mounted on its side.
struct Level {
    std::array<char, 2> axes{'x', 'y'};  ///< Letters of the horizontal axes.
    /// Tilt of both; positive if the + end is higher than at the first set-up.
    std::array<double, 2> tilt_arcmin{};
    bool is_within = true;              ///< Both are within kMostTiltArcmin.
    std::vector<text::Message> advice;  ///< "lower the +x side by 2.4'"; empty if within.
};

/// Limit of the tilt in arc minutes, 0.02 deg.  With 10 mg bias of a horizontal axis it changes the
/// norm by 3.4 mGal.
inline constexpr double kMostTiltArcmin = 1.2;

/// Keeps 24 h of envelopes and of the 2 s series, and at least 90 s at full rate; 7 MB at 50 Hz.
/// Thread-safe.
class Record {
public:
    /// `profile` must outlive this.
    Record(const wire::DeviceProfile& profile, int rate_hz, const verdict::Options& options);

    /// Takes a sample; samples come in the order of their times.  A sample earlier than the last
    /// one means that the clock was set back; later data are then removed.
    void take(const PlacedSample& sample);
    void take(const OvenPoint& point);

    /// Declares that everything taken so far is from the archive or a journal.  Samples that a replay
    /// delivers again are ignored, up to the first new one.
    void end_of_history();

    /// Declares that another sensor records: verdict and readings begin afresh, as after a power-on.
    /// The charts keep the samples of the sensor before.
    /// @param last  time of the last sample of the sensor before.
    void begin_unit(UtcTime last);

    /// @name See RecentSamples and History.
    /// @{
    [[nodiscard]] std::uint64_t end() const;
    [[nodiscard]] std::optional<Block> block_from(std::uint64_t& cursor, std::size_t most) const;
    [[nodiscard]] std::vector<Envelope> history(Channel channel, UtcTime from, UtcTime to,
                                                std::size_t points) const;
    /// @}
    /// Returns every n-th value of an oven in [from, to), so that at most `points` (>= 1) remain.
    [[nodiscard]] std::vector<OvenPoint> oven_history(journal::OvenPlace place, UtcTime from,
                                                      UtcTime to, std::size_t points) const;

    /// Uses these thresholds from now on, and judges the stored series again.
    void judge_by(const verdict::Options& options);

    /// Returns the verdict on the data so far, also if there are none.  The caller must check the
    /// age of the data.
    [[nodiscard]] verdict::Verdict verdict() const;

    /// Returns the state of the verdict at an instant of the data; the same for the same samples, at
    /// any speed.
    [[nodiscard]] verdict::State state_at(UtcTime time) const;

    /// Returns the time of the last sample; std::nullopt if there is none.
    [[nodiscard]] std::optional<UtcTime> last_sample() const;

    /// Returns what is not believable of the samples since the end of the history, also in comparison
    /// with it.
    [[nodiscard]] std::vector<text::Message> troubles() const;

    /// Returns the reading of these set-ups together, as far as they are in memory.
    /// Data outside do not affect it.
    [[nodiscard]] verdict::RunningReading reading(
        std::span<const events::Occupation::SetUp> set_ups) const;

    /// Returns the length of signal that is missing between the samples in [from, to), in s.
    [[nodiscard]] double missing_s(UtcTime from, UtcTime to) const;

    /// Returns the motion of the box in [from, to): the 2 s series, each sample with the shaking around
    /// it.
    [[nodiscard]] std::vector<signal::MotionSample> motion(UtcTime from, UtcTime to) const;

    /// Returns the tilt of the last 2 s relative to the median of a set-up; std::nullopt if one of
    /// the two is not known.  The set-up includes the lifting of the box at its end.
    [[nodiscard]] std::optional<Level> level_against(UtcTime from, UtcTime to) const;

    [[nodiscard]] const wire::DeviceProfile& profile() const noexcept { return profile_; }
    [[nodiscard]] int rate_hz() const noexcept { return rate_hz_; }

private:
    void forget_from(UtcTime time);
    void judge_again();
    void note_state();

    const wire::DeviceProfile& profile_;
    int rate_hz_;
    verdict::Options options_;
    mutable std::mutex mutex_;
    RecentSamples recent_;
    History history_;
    Thinning thinning_;
    verdict::Judge judge_;
    struct Since {
        UtcTime time;
        verdict::State state;
    };
    std::deque<Since> states_;  ///< Changes of the state.
    believable::Watch watch_;
    std::vector<verdict::LiveSample> fresh_;  ///< Kept for reuse.
    std::deque<verdict::LiveSample> thinned_;
    std::array<std::deque<OvenPoint>, 2> ovens_;  ///< In the order of OvenPlace.
    struct Gap {
        UtcTime from, time;  ///< When a sample was missing first, and the next one that came.
    };
    std::deque<Gap> gaps_;
    std::optional<UtcTime> last_;
    std::optional<UtcTime> history_end_;  ///< Set while a replay may deliver old samples again.
};

/// Returns the last sample of the sensor before the present one; std::nullopt if the log has no
/// exchange.
[[nodiscard]] std::optional<UtcTime> last_exchange(const std::vector<events::Event>& log);

/// Loads the 24 h before `now` from the archive into `record` (above 50 Hz the same number of
/// samples), so that history, verdict and running occupation are the same after a restart.  Damaged
/// data are skipped.
/// @throws std::system_error  a file cannot be read; data before it were loaded.
void take_archived_past(const std::filesystem::path& archive, const journal::StationCodes& codes,
                        UtcTime now, Record& record);

}  // namespace a351::daemon::live
