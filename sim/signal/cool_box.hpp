#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/units.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim::signal {

/// Air inside the cool box, around the oven; one value a second from the start of the record:
///
///     a(t) = course(t) + walk(t) + d(t)
///     lid open: tau_open dd/dt = outside - a,   lid closed: tau_closed dd/dt = -d
class CoolBox {
public:
    static constexpr double kStepSeconds = 1.0;

    CoolBox(const scenario::Scenario& scenario, const std::vector<scenario::PlannedSetUp>& plan,
            std::uint64_t seed);

    /// Returns the value at the start of the record, then the next one with each call.
    [[nodiscard]] DegC next();

private:
    struct OpenLid {
        UtcTime from, to;
        double outside_degc = 0.0;
    };

    UtcTime time_;
    std::vector<scenario::AmbientKnot> course_;
    std::vector<OpenLid> open_lids_;
    noise::RandomStream walk_;
    double kick_degc_, open_gain_, closed_keep_;
    double walk_degc_ = 0.0, lid_degc_ = 0.0;
};

}  // namespace a351::sim::signal
