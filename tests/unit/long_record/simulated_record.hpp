#pragma once

#include "corrector/long_record/record_segments.hpp"
#include "corrector/long_record/two_path_fit.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/plant_statistics.hpp"

namespace a351::corrector::long_record {

/// Returns the scenario with units drawn by seed within +-25 %, so that their parameters are not in
/// the middle of the fit's priors.
inline sim::scenario::Scenario of_drawn_units(const std::string& name) {
    sim::scenario::Scenario scenario = sim::scenario::load_scenario(name);
    scenario.unit_scatter = 0.25;
    return scenario;
}

/// Returns a record without a break, made of the scenario's 20 s means.
inline RecordSegment simulated_segment(const sim::scenario::Scenario& scenario,
                                       std::uint64_t seed) {
    const sim::IndoorRecord record = sim::indoor_record(scenario, seed);
    RecordSegment segment;
    segment.quantity = record.difference_mgal;
    segment.temperature_degc = record.temperature_degc;
    return segment;
}

inline RecordSegment simulated_segment(const std::string& scenario, std::uint64_t seed) {
    return simulated_segment(sim::scenario::load_scenario(scenario), seed);
}

inline TwoPathFit fitted(const sim::scenario::Scenario& scenario, std::uint64_t seed) {
    const RecordSegment segment = simulated_segment(scenario, seed);
    return fit_two_paths(segment.temperature_degc, segment.quantity, kRecordStep_s, 900.0);
}

inline TwoPathFit fitted(const std::string& scenario, std::uint64_t seed) {
    return fitted(sim::scenario::load_scenario(scenario), seed);
}

}  // namespace a351::corrector::long_record
