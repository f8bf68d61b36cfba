#pragma once

#include <cstdint>
#include <utility>

namespace a351::daemon {

/// Detects that the sample counter advances by a constant step other than the expected one, which
/// means another output rate.
class StepWatch {
public:
    explicit StepWatch(std::uint16_t expected) : expected_(expected) {}

    /// Takes the next counter value.  @return true once the same wrong step was repeated
    /// kStepsToBelieve times.
    [[nodiscard]] bool is_altered(std::uint16_t count) {
        const auto step = static_cast<std::uint16_t>(count - std::exchange(last_count_, count));
        const bool continues = step == std::exchange(last_step_, step) && step != expected_;
        times_ = continues ? times_ + 1 : 0;
        return times_ >= kStepsToBelieve;
    }

private:
    // Repetitions of the step.  Fewer may be lost frames or a counter that is stuck for a while.
    static constexpr int kStepsToBelieve = 20;

    std::uint16_t expected_;
    std::uint16_t last_count_ = 0, last_step_ = 0;
    int times_ = 0;
};

}  // namespace a351::daemon
