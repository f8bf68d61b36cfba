#pragma once
/// @file
/// A fault script: faults and their times.  Strict TOML; config/faults/example.toml shows all keys.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "sim/line/fault.hpp"
#include "sim/noise/random.hpp"

namespace a351::sim::line {

struct PlannedFault {
    Fault fault;
    std::optional<UtcTime> at;             ///< Simulated; compared with the instants of frames.
    std::optional<std::int64_t> at_frame;  ///< Without `at`: frames that the device makes before.
};

/// Faults of one kind at random instants.
struct RandomFaults {
    Fault fault;  ///< All keys at their defaults.
    double per_h = 0.0;
};

struct FaultScript {
    std::vector<PlannedFault> planned;  ///< In the order written.
    std::vector<RandomFaults> random;
    std::uint64_t seed = 1;           ///< Seed of all draws, including the places of damage.
    bool answers_cut_frames = false;  ///< Answers are put into the middle of streamed frames.
};

/// Reads a fault script.
/// @param start  simulated instant from which `at_s` counts.
/// @throws InputError  the file cannot be read; a fault has no instant or several; as read_fault().
[[nodiscard]] FaultScript read_fault_script(const std::filesystem::path& file, UtcTime start,
                                            const FaultRules& rules);

/// Reads a fault script from text; messages use `origin` as the file name.
[[nodiscard]] FaultScript parse_fault_script(std::string_view toml,
                                             const std::filesystem::path& origin, UtcTime start,
                                             const FaultRules& rules);

/// The faults of a script in the order in which they are due.  Random faults are one Poisson
/// process per kind, which depends on the seed and the start only.
class FaultSchedule {
public:
    FaultSchedule(const FaultScript& script, UtcTime start);

    /// Returns the next fault that is due, each once; std::nullopt if none is.
    /// @param now          simulated time.
    /// @param frames_made  frames that the device has made so far.
    [[nodiscard]] std::optional<Fault> take_due(UtcTime now, std::int64_t frames_made);

private:
    struct RandomKind {
        Fault fault;
        double per_h = 0.0;
        noise::RandomStream waits;
        UtcTime next;
    };
    static void draw_next(RandomKind& kind);
    void find_next();

    std::vector<PlannedFault> planned_;  ///< Not yet taken.
    std::vector<RandomKind> random_;
    UtcTime next_at_ = UtcTime::max();  ///< Earliest instant of a fault not yet taken.
    std::int64_t next_frame_ = 0;       ///< Smallest at_frame not yet taken.
};

}  // namespace a351::sim::line
