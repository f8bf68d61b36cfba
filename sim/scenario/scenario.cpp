#include "sim/scenario/scenario.hpp"

namespace a351::sim {

UtcTime Scenario::start() const {
    return occupations.front().centre - from_seconds(3600.0 * schedule.lead_in_h);
}

UtcTime Scenario::end() const {
    return occupations.back().centre + from_seconds(60.0 * schedule.lead_out_min);
}

DegC Scenario::ambient(UtcTime time) const {
    UtcTime before = start();
    double before_degc = schedule.ambient_before_degc;
    if (time <= before) return DegC(before_degc);
    const auto between = [&](UtcTime after, double after_degc) {
        const double share = seconds_between(before, time) / seconds_between(before, after);
        return DegC(before_degc + share * (after_degc - before_degc));
    };
    for (const ListedOccupation& occupation : occupations) {
        if (time < occupation.centre) return between(occupation.centre, occupation.ambient_degc);
        before = occupation.centre;
        before_degc = occupation.ambient_degc;
    }
    return time < end() ? between(end(), schedule.ambient_after_degc)
                        : DegC(schedule.ambient_after_degc);
}

}  // namespace a351::sim
