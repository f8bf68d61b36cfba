#pragma once

#include <array>
#include <optional>
#include <vector>

#include "daemon/believable/limits.hpp"
#include "daemon/believable/second.hpp"
#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::believable {

/// Watches the axes.  An axis is dead if it has not changed for kConfirm_s.  The
/// quietest sensor of the family, the M-A370AD10, has a noise of one count: 0.02 uG/sqrt(Hz) over
/// 9 Hz (its brief sheet).  A scale is wrong if the norm of the box at rest is outside its limits,
/// or if an axis is beyond the rated range: the sensor limits its output to this range.
///
/// Bytes are exchanged if a higher byte of an axis changes more often than the lowest one for
/// kConfirm_s; this trouble lasts until the watch begins again.
///
/// A box that is knocked, lifted or driven is not at rest, and says nothing about its scale.  The
/// trouble of a scale lasts until a box at rest contradicts it.
class AxesWatch {
public:
    explicit AxesWatch(const wire::DeviceProfile& profile);

    void take(const Second& second);
    void append_troubles(std::vector<text::Message>& troubles) const;

private:
    void judge_life(const Second& second);
    void judge_scale(const Second& second);

    double g_per_count_, most_g_;
    std::array<Lasting, kAxisCount> constant_{Lasting(kConfirm_s), Lasting(kConfirm_s),
                                              Lasting(kConfirm_s)};
    std::array<bool, kAxisCount> is_dead_{};
    Lasting exchanged_{kConfirm_s};
    bool is_exchanged_ = false;
    Lasting wrong_{kConfirm_s + 1};  ///< The other troubles explain this one, and come first.
    std::optional<StandardGravity> wrong_norm_;  ///< Norm at the begin of the trouble.
};

}  // namespace a351::daemon::believable
