#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/line/fault_script.hpp"
#include "sim/noise/random.hpp"

namespace a351::sim {

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
        RandomStream waits;
        UtcTime next;
    };
    static void draw_next(RandomKind& kind);
    void find_next();

    std::vector<PlannedFault> planned_;  ///< Not yet taken.
    std::vector<RandomKind> random_;
    UtcTime next_at_ = UtcTime::max();  ///< Earliest instant of a fault not yet taken.
    std::int64_t next_frame_ = 0;       ///< Smallest at_frame not yet taken.
};

}  // namespace a351::sim
