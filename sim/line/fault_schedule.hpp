#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/line/fault_script.hpp"
#include "sim/noise/random.hpp"

namespace a351::sim {

/// The faults of a script in the order in which they fall due.  Random ones are a Poisson process
/// per kind, from the seed and the start alone.
class FaultSchedule {
public:
    FaultSchedule(const FaultScript& script, UtcTime start);

    /// The next fault that is due, until there is none.
    /// @param now          simulated.
    /// @param frames_made  by the device so far.
    [[nodiscard]] std::optional<Fault> take_due(UtcTime now, std::int64_t frames_made);

private:
    struct RandomKind {
        Fault fault;
        double per_h = 0.0;
        RandomStream waits;
        UtcTime next;
    };
    static void draw_next(RandomKind& kind);
    void find_next();

    std::vector<PlannedFault> planned_;  ///< Not yet taken.
    std::vector<RandomKind> random_;
    UtcTime next_at_ = UtcTime::max();  ///< Earliest of those with an instant.
    std::int64_t next_frame_ = 0;       ///< Least of those with a frame.
};

}  // namespace a351::sim
