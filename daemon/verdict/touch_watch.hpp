#pragma once

#include <array>
#include <deque>
#include <optional>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon::verdict {

/// Detects knocks, handling of the box and its move to another place; measures the noise.
class TouchWatch {
public:
    explicit TouchWatch(const Options& options) : options_(options) {}

    void take(const LiveSample& sample);

    /// Returns true if the last knock does not reach the sample's values through the filters.
    [[nodiscard]] bool is_clean(const LiveSample& sample) const noexcept;

    /// Returns the end of the last knock, and of the last handling of the box.
    [[nodiscard]] std::optional<UtcTime> last_knock() const noexcept { return last_knock_; }
    [[nodiscard]] std::optional<UtcTime> last_handled() const noexcept { return last_handled_; }

    /// Returns the last time at which shaking exceeded its usual level (the median of ten minutes),
    /// by a knock or otherwise.
    [[nodiscard]] std::optional<UtcTime> last_shaking() const noexcept { return last_shaking_; }

    /// Returns the ratio of the noise to its usual level, the median of the minutes of the last
    /// hour; 1 until ten minutes are known.
    [[nodiscard]] double noise_ratio() const noexcept;

private:
    void follow_shake(const LiveSample& sample);
    void follow_tilt(const LiveSample& sample);
    void follow_noise(const LiveSample& sample);

    Options options_;
    std::optional<UtcTime> knock_begun_;
    std::optional<UtcTime> last_shaken_;  ///< Like last_knock_, but not set by a change of tilt.
    std::optional<UtcTime> last_knock_, last_handled_, last_shaking_;
    std::deque<double> shakes_mgal_;
    std::deque<std::array<double, 3>> tilts_mgal_;  ///< All axes.
    std::deque<double> norms_mgal_;
    std::deque<double> minutes_mgal_;  ///< Noise of past minutes.
    int since_minute_ = 0;
    double noise_mgal_ = 0.0;  ///< Rms of the norm about its mean in the last minute.
};

}  // namespace a351::daemon::verdict
