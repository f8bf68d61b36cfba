#include "sim/scenario/scenario.hpp"

#include <algorithm>

namespace a351::sim::scenario {

UtcTime Scenario::start() const {
    return fixed_record ? fixed_record->start
                        : occupations.front().centre - from_seconds(3600.0 * schedule.lead_in_h);
}

UtcTime Scenario::end() const {
    return fixed_record ? fixed_record->start + from_seconds(3600.0 * fixed_record->duration_h)
                        : occupations.back().centre + from_seconds(60.0 * schedule.lead_out_min);
}

std::vector<AmbientKnot> Scenario::ambient_knots() const {
    std::vector<AmbientKnot> knots;
    for (const ListedAmbient& listed : ambient) {
        const UtcTime time =
            listed.hours ? start() + from_seconds(3600.0 * *listed.hours) : listed.utc;
        knots.push_back({time, listed.degc});
    }
    if (!knots.empty()) return knots;
    knots.push_back({start(), schedule.ambient_before_degc});
    for (const ListedOccupation& occupation : occupations) {
        knots.push_back({occupation.centre, *occupation.ambient_degc});
    }
    knots.push_back({end(), schedule.ambient_after_degc});
    return knots;
}

DegC ambient_at(const std::vector<AmbientKnot>& knots, UtcTime time) {
    const auto after = std::ranges::upper_bound(knots, time, {}, &AmbientKnot::time);
    if (after == knots.begin()) return DegC(after->degc);
    const AmbientKnot& before = *(after - 1);
    if (after == knots.end()) return DegC(before.degc);
    const double share =
        seconds_between(before.time, time) / seconds_between(before.time, after->time);
    return DegC(before.degc + share * (after->degc - before.degc));
}

}  // namespace a351::sim::scenario
