#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "daemon/live/history.hpp"
#include "daemon/verdict/live_sample.hpp"
#include "protocol/signal/decimator.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::live {

/// Samples -> the live series of one value in 2 s, with the decimation of a351-correct: to 5 Hz,
/// then by ten.  Values whose filters touch missing samples are NaN.  After a gap of more than
/// a minute, or if time is set back, the series begins again.  Blocks of 2 s are counted by the
/// index of the session, so they have the same samples at any speed.  The index of samples from the
/// archive is another one, so after a restart the blocks may begin elsewhere.
class Thinning {
public:
    /// @param rate_hz  a multiple of 10, >= 10: all output rates of the profiles are.
    Thinning(const wire::DeviceProfile& profile, int rate_hz);

    /// Takes a sample, and appends to `output` the values that are complete with it.
    void take(const PlacedSample& sample, std::vector<verdict::LiveSample>& output);

    /// Begins the series again: no earlier sample enters a later value.
    void begin_run();

private:
    using Values = std::array<double, kLiveChannelCount>;

    void add(UtcTime time, const Values& values, std::vector<verdict::LiveSample>& output);
    void push_block(std::vector<verdict::LiveSample>& output);
    [[nodiscard]] MilliGal shake_of_block() const;

    const wire::DeviceProfile& profile_;
    double interval_s_;
    std::size_t block_size_;  ///< Samples in 2 s.
    signal::DecimationFilter to_5_hz_, by_ten_;
    std::vector<signal::Decimator> first_, second_;  ///< Filters by channel.
    std::array<std::vector<double>, kLiveChannelCount> block_, at_5_hz_, thinned_;
    std::deque<UtcTime> begins_;  ///< Begin of each block whose value is not complete.
    std::optional<UtcTime> last_;
};

}  // namespace a351::daemon::live
