#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/core/utc_time.hpp"

namespace a351::daemon::believable {

/// Counts of a sample in the order x, y, z, temperature.
using Counts = std::array<std::int32_t, 4>;
inline constexpr std::size_t kAxisCount = 3, kTemperature = 3;

/// A second of samples.
struct Second {
    struct Range {
        std::int32_t least = 0, most = 0;
        double mean = 0.0;  ///< Counts.
        /// Share of the samples in which a byte differs from that of the sample before, the lowest
        /// byte first.
        std::array<double, 4> byte_changes{};

        [[nodiscard]] bool is_constant() const noexcept { return least == most; }
    };
    UtcTime end;  ///< Time of the last sample.
    std::array<Range, 4> channels{};
};

/// Confirms a condition that has lasted for a number of seconds.
class Lasting {
public:
    explicit Lasting(int needed_s) : needed_s_(needed_s) {}

    /// Takes the condition of the next second; returns true once it has lasted.
    bool take(bool holds) noexcept {
        lasted_s_ = holds ? lasted_s_ + 1 : 0;
        return lasted_s_ >= needed_s_;
    }

private:
    int needed_s_;
    int lasted_s_ = 0;
};

}  // namespace a351::daemon::believable
