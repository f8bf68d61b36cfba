#pragma once

#include <array>
#include <optional>
#include <vector>

#include "daemon/believable/limits.hpp"
#include "daemon/believable/second.hpp"
#include "protocol/text/message.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::believable {

/// Compares a box at rest with its past: the data before the start of the recorder, and this run.
///
/// A stance is an axis that points up or down, see kLeastVertical.  The first stance of a
/// run that lasts for kStance_s must be one in which the box was at rest as long before the start:
/// otherwise two axes are exchanged, or one is turned over.  Later ones are not judged, because a box
/// is turned to calibrate it.  The trouble ends when the box is in a stance of the past; at the next
/// start the new stance is one.  x and y exchanged cannot be seen.
///
/// The norm, a mean of kMinute_s at rest, must stay within kMostNormChange of a reference of the
/// same stance: its first norm, which is replaced by a norm within the limit after a day.
/// Otherwise the scale or a bias changes.
class RestWatch {
public:
    explicit RestWatch(const wire::DeviceProfile& profile);

    void take(const Second& second);
    /// Declares that everything so far was before the start.
    void end_of_history();
    /// Begins a new time at rest: there is a gap.
    void interrupt();
    void append_troubles(std::vector<text::Message>& troubles) const;

private:
    struct Stance {
        std::size_t number = 0;  ///< 2 x axis, and 1 more if the axis points down.
        StandardGravity norm;
    };
    /// Memory of a stance.
    struct Past {
        int before_s = 0, now_s = 0;          ///< Time at rest before the start, and since then.
        std::optional<StandardGravity> norm;  ///< Mean to compare with,
        UtcTime norm_time;                    ///< and its time.
    };

    [[nodiscard]] std::optional<Stance> stance_of(const Second& second) const;
    void judge_stance();
    void judge_norm(UtcTime now, StandardGravity norm);

    double g_per_count_;
    std::array<Past, 2 * kAxisCount> pasts_{};
    bool is_compared_ = false;  ///< The first stance of the run is known.
    std::optional<std::size_t> stance_;
    int rested_s_ = 0;      ///< Time in stance_ without a pause.
    double norms_g_ = 0.0;  ///< Sum of the norms of the open minute.
    std::optional<std::size_t> strange_stance_;
    Lasting changed_{kNormMinutes};
    std::optional<double> change_g_;  ///< Change of the norm at the begin of the trouble.
};

}  // namespace a351::daemon::believable
