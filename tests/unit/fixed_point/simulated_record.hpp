#pragma once

#include "corrector/fixed_point/record_segments.hpp"
#include "tests/support/plant_statistics.hpp"

namespace a351::corrector {

/// A record without a break, from the scenario's 20 s means.
inline RecordSegment simulated_segment(const std::string& scenario, std::uint64_t seed) {
    const sim::IndoorRecord record = sim::indoor_record(sim::load_scenario(scenario), seed);
    RecordSegment segment;
    segment.acceleration_mgal = record.difference_mgal;
    segment.temperature_degc = record.temperature_degc;
    return segment;
}

}  // namespace a351::corrector
