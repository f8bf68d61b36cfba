#pragma once

#include <array>
#include <deque>
#include <optional>

#include "daemon/verdict/live_sample.hpp"
#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon {

/// Knocks, hands, and a box that was brought to another place; and how noisy the series is.
class TouchWatch {
public:
    explicit TouchWatch(const VerdictOptions& options);

    void take(const LiveSample& sample);

    /// Nothing of the last knock reaches into the sample's values.
    [[nodiscard]] bool is_clean(const LiveSample& sample) const noexcept;

    /// End of the last knock; of the last that was a hand at the box.
    [[nodiscard]] std::optional<UtcTime> last_knock() const noexcept { return last_knock_; }
    [[nodiscard]] std::optional<UtcTime> last_handled() const noexcept { return last_handled_; }

    /// Last shaking above its usual level, the median of ten minutes, knock or not.
    [[nodiscard]] std::optional<UtcTime> last_shaking() const noexcept { return last_shaking_; }

    /// Rms of the last minute of the norm about its mean, with its ratio to the usual level: the
    /// median of the minutes of the last hour.  1 until ten of them are known.
    [[nodiscard]] double noise_mgal() const noexcept { return noise_mgal_; }
    [[nodiscard]] double noise_ratio() const noexcept;

private:
    void follow_shake(const LiveSample& sample);
    [[nodiscard]] double usual_shake_mgal() const;
    void follow_tilt(const LiveSample& sample);
    void follow_noise(const LiveSample& sample);

    VerdictOptions options_;
    std::optional<UtcTime> knock_begun_;
    std::optional<UtcTime> last_shaken_;  ///< As last_knock_, but for another tilt.
    std::optional<UtcTime> last_knock_, last_handled_, last_shaking_;
    std::deque<double> shakes_mgal_;
    std::deque<std::array<double, 2>> tilts_mgal_;  ///< Horizontal axes.
    std::deque<double> norms_mgal_;
    std::deque<double> minutes_mgal_;  ///< Noise of past minutes.
    int since_minute_ = 0;
    double noise_mgal_ = 0.0;
};

}  // namespace a351::daemon
