#pragma once

#include <cstdint>
#include <utility>

namespace a351::daemon {

/// Whether the counter keeps to a step that is not that of the rate asked for.
class StepWatch {
public:
    explicit StepWatch(std::uint16_t expected) : expected_(expected) {}

    [[nodiscard]] bool is_altered(std::uint16_t count) {
        const auto step = static_cast<std::uint16_t>(count - std::exchange(last_count_, count));
        const bool goes_on = step == std::exchange(last_step_, step) && step != expected_;
        times_ = goes_on ? times_ + 1 : 0;
        return times_ >= kStepsToBelieve;
    }

private:
    // Losses and stuck counters of some frames are no other rate.
    static constexpr int kStepsToBelieve = 20;

    std::uint16_t expected_;
    std::uint16_t last_count_ = 0, last_step_ = 0;
    int times_ = 0;
};

}  // namespace a351::daemon
