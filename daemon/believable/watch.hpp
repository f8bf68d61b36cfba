#pragma once
/// @file
/// Finds values that no working sensor sends, or that a wrong profile has converted.  No public
/// document of the M-A351 is known, so the first sensor that is connected tests its profile.

#include <optional>
#include <vector>

#include "daemon/believable/axes_watch.hpp"
#include "daemon/believable/rest_watch.hpp"
#include "daemon/believable/second.hpp"
#include "daemon/believable/temperature_watch.hpp"
#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::believable {

/// Watches the samples of one sensor, second by second of data: a clock that is set changes
/// nothing.  Limits and their sources: limits.hpp.
class Watch {
public:
    /// `profile` must outlive this.
    /// @param rate_hz  > 0
    Watch(const wire::DeviceProfile& profile, int rate_hz)
        : profile_(profile),
          rate_hz_(rate_hz),
          axes_(profile),
          rest_(profile),
          temperature_(profile) {}

    /// Takes the next sample.  After a gap of kLongGap_s, or if time is set back by this, the watch
    /// begins again.
    void take(UtcTime time, const Counts& counts);
    /// Declares that everything so far was before the start: only RestWatch remembers it.
    void end_of_history();
    /// Forgets everything: another sensor is attached.
    void forget();
    /// See TemperatureWatch.
    void take_oven(UtcTime time, std::optional<DegC> oven, DegC set_point) {
        temperature_.take_oven(time, oven, set_point);
    }

    /// Returns the troubles, with their remedies.  A text does not vary while its trouble lasts.
    [[nodiscard]] std::vector<text::Message> troubles() const;

private:
    void restart();

    const wire::DeviceProfile& profile_;
    int rate_hz_;
    AxesWatch axes_;
    RestWatch rest_;
    TemperatureWatch temperature_;
    std::optional<UtcTime> last_;
    Second second_;  ///< Means and shares are sums until it is complete.
    int count_ = 0;
    Counts before_{};  ///< Counts of the sample before.
};

}  // namespace a351::daemon::believable
