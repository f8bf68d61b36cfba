#pragma once
/// @file
/// Ten minutes of signal, dense with faults, in simulated time.

#include <cstdint>
#include <string>

namespace a351::simulation {

struct Outcome {
    std::string broken;  ///< The invariant that does not hold; empty if all do.
    double signal_s = 0.0, simulated_s = 0.0;
    int faults = 0, runs = 0;
    std::int64_t samples = 0, promised = 0, archived = 0;
    std::uint64_t events = 0, turns = 0, digest = 0;
};

/// Runs one simulation in a child process, because the threads of killed recorders remain.
/// @param is_traced  the log of the recorders and the faults go to stderr.
[[nodiscard]] Outcome simulate(std::uint64_t seed, bool is_traced);

}  // namespace a351::simulation
