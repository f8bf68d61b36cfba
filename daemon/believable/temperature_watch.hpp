#pragma once

#include <optional>
#include <vector>

#include "daemon/believable/limits.hpp"
#include "daemon/believable/second.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::believable {

/// Watches the temperature.  It is wrong if it is outside its limits for kConfirm_s, or more than
/// kMostFromOven_degc from an oven at its set point while neither moves for kFrozen_s.  A box that
/// warms up moves, and an oven in a hot car is above its set point.
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
    void judge_range(DegC temperature);
    void judge_oven(UtcTime now, DegC temperature);
    void judge_life(const Second::Range& counts);

    struct OvenAnswer {
        UtcTime time;
        DegC oven;
        bool is_at_set_point = false;
    };

    double slope_degc_, offset_degc_;  ///< degC = slope x counts + offset.
    Lasting outside_{kConfirm_s};
    std::optional<DegC> outside_degc_;  ///< Temperature at the begin of the trouble.

    std::optional<OvenAnswer> answer_;
    DegC still_at_;  ///< Temperature at the begin of the time in which it has hardly moved.
    Lasting off_{kFrozen_s};
    std::optional<DegC> off_degc_;  ///< Temperature at the begin of the trouble.

    int frozen_after_s_;
    std::int32_t last_ = 0;
    int equal_s_ = 0, longest_pause_s_ = 0;
    bool is_frozen_ = false;
};

}  // namespace a351::daemon::believable
