#include "sim/signal/cool_box.hpp"

#include <algorithm>
#include <cmath>

namespace a351::sim::signal {

CoolBox::CoolBox(const scenario::Scenario& scenario,
                 const std::vector<scenario::PlannedSetUp>& plan, std::uint64_t seed)
    : time_(scenario.start()),
      course_(scenario.ambient_knots()),
      walk_(scenario.box_seed(seed), "ambient"),
      kick_degc_(scenario.cool_box.walk_degc_per_sqrt_h * std::sqrt(kStepSeconds / 3600.0)),
      open_gain_(1.0 - std::exp(-kStepSeconds / scenario.cool_box.open_tau_s)),
      closed_keep_(std::exp(-kStepSeconds / scenario.cool_box.closed_tau_s)) {
    for (const scenario::ListedOpenLid& listed : scenario.open_lids) {
        if (listed.site.empty()) {
            open_lids_.push_back({listed.from, listed.to, listed.outside_degc});
            continue;
        }
        for (const scenario::PlannedSetUp& set_up : plan) {
            if (set_up.site.name == listed.site && set_up.number == listed.number) {
                open_lids_.push_back({set_up.start, set_up.end, listed.outside_degc});
            }
        }
    }
}

DegC CoolBox::next() {
    const double closed_degc = scenario::ambient_at(course_, time_).value() + walk_degc_;
    const DegC inside(closed_degc + lid_degc_);
    const auto open = std::find_if(open_lids_.begin(), open_lids_.end(), [this](const auto& lid) {
        return lid.from <= time_ && time_ < lid.to;
    });
    if (open == open_lids_.end()) {
        lid_degc_ *= closed_keep_;
    } else {
        lid_degc_ += open_gain_ * (open->outside_degc - inside.value());
    }
    if (kick_degc_ > 0.0) walk_degc_ += kick_degc_ * walk_.normal();
    time_ += from_seconds(kStepSeconds);
    return inside;
}

}  // namespace a351::sim::signal
