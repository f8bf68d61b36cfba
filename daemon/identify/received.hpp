#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/identify/observation.hpp"
#include "protocol/wire/burst_frame.hpp"

namespace a351::daemon::identify {

/// Content of the bytes of a sensor.
struct Received {
    std::vector<wire::BurstValues> frames;
    std::size_t skipped = 0;  ///< Bytes that belong to no frame.
    /// Most frequent difference of COUNT between frames; 0 with fewer than two frames.
    std::uint16_t count_step = 0;
    double rate_hz = 0.0;  ///< Frames per second, lost ones included; 0 if it cannot be computed.

    struct Axis {
        double mean_counts = 0.0;
        double deviation_counts = 0.0;  ///< Standard deviation of the samples.
        /// Standard deviation of one sample, from the differences of successive samples: a slow
        /// change is not in it.
        double noise_counts = 0.0;
        bool is_constant = true;  ///< All samples are equal.
    };
    std::array<Axis, 3> axes;
};

/// Decodes the bytes of an observation.
/// @param layout  fields of the frames, which must include COUNT.
[[nodiscard]] Received received(const Observation& seen, wire::BurstLayout layout);

}  // namespace a351::daemon::identify
