#pragma once
/// @file
/// A fault script: which faults happen when.  Strict TOML; config/faults/example.toml shows it all.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "sim/line/fault.hpp"

namespace a351::sim {

struct PlannedFault {
    Fault fault;
    std::optional<UtcTime> at;  ///< Simulated; for frames: of the instant they stand for.
    std::optional<std::int64_t> at_frame;  ///< Frames the device made before, else.
};

/// Faults of one kind at random instants.
struct RandomFaults {
    Fault fault;  ///< With the defaults of its keys.
    double per_h = 0.0;
};

struct FaultScript {
    std::vector<PlannedFault> planned;  ///< As written.
    std::vector<RandomFaults> random;
    std::uint64_t seed = 1;           ///< Of everything that is drawn, places of damage included.
    bool answers_cut_frames = false;  ///< Answers while frames stream come in the midst of one.
};

/// @param start  simulated instant that `at_s` counts from.
/// @throws InputError  the file cannot be read; a fault without or with two instants; as read_fault.
[[nodiscard]] FaultScript read_fault_script(const std::filesystem::path& file, UtcTime start,
                                            const FaultRules& rules);

/// The same from text; `origin` stands for the file name in messages.
[[nodiscard]] FaultScript parse_fault_script(std::string_view toml,
                                             const std::filesystem::path& origin, UtcTime start,
                                             const FaultRules& rules);

}  // namespace a351::sim
