#pragma once

#include <optional>
#include <vector>

#include "daemon/believable/limits.hpp"
#include "daemon/believable/second.hpp"
#include "daemon/believable/temperature_format.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::believable {

/// Watches the temperature.  Its conversion is wrong if for kConfirm_s
///
///   - the counts are not possible in the format of the profile (TemperatureFormat::is_possible()), or
///   - they are far from the oven and do not approach it, while in another format of the family they
///     are near the oven, at a usual temperature.
///
/// A box of the time constant T that is D from its oven approaches it by D t / T in a short time t;
/// half of this is demanded, for the noise.  The trouble names the format that the counts fit.
///
/// The sensor does not follow its oven if it is more than kMostFromOven_degc from an oven at its set
/// point while neither moves for kFrozen_s.  A box that warms up moves, and an oven in a hot car is
/// above its set point.
///
/// It is frozen if its counts are equal for kFrozen_s, for a coarse counter in proportion to its
/// step, and for kFrozenPauses times the longest pause of this unit.
class TemperatureWatch {
public:
    explicit TemperatureWatch(const wire::DeviceProfile& profile);

    void take(const Second& second);
    /// Takes an answer of the oven's controller.
    /// @param oven  temperature of the oven; std::nullopt if the controller does not know it.
    void take_oven(UtcTime time, std::optional<DegC> oven, DegC set_point);
    void append_troubles(std::vector<text::Message>& troubles) const;

private:
    struct OvenAnswer {
        UtcTime time;
        DegC oven;
        bool is_at_set_point = false;
    };
    struct Place {
        UtcTime time;
        DegC temperature;
    };

    void judge_conversion(UtcTime now, const TemperatureCounts& counts);
    [[nodiscard]] bool approaches(DegC oven, const Place& now) const;
    void judge_oven(DegC temperature);
    void judge_life(const Second::Range& counts);

    TemperatureFormat own_;  ///< Format of the profile.
    Lasting unfit_{kConfirm_s};
    std::optional<text::Message> conversion_;  ///< Trouble, as at its begin.
    bool is_by_oven_ = false;                  ///< The oven contradicts it.
    std::optional<Place> far_;                 ///< Since then another format is nearer to the oven.

    std::optional<OvenAnswer> answer_;  ///< Absent if there is none, or if it is old.
    DegC still_at_;  ///< Temperature at the begin of the time in which it has hardly moved.
    Lasting off_{kFrozen_s};
    std::optional<DegC> off_degc_;  ///< Temperature at the begin of the trouble.

    int frozen_after_s_;
    std::int32_t last_ = 0;
    int equal_s_ = 0, longest_pause_s_ = 0;
    bool is_frozen_ = false;
};

}  // namespace a351::daemon::believable
