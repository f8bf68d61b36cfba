#pragma once
/// @file
/// Short vibrations of the box: passing vehicles, handling at both ends of a set-up, and occasional
/// knocks in the middle of one.

#include <array>
#include <cstdint>
#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim::signal {

/// An oscillation on all axes under an envelope.
struct Burst {
    enum class Envelope { swell, decay, growth };  ///< Hann; (1 - u)^3; u^3 with u = 0 ... 1.
    Envelope envelope = Envelope::swell;
    double start_s = 0.0;  ///< Since the start of the record.
    double length_s = 0.0;
    std::array<double, 3> peak_mgal{};
    std::array<double, 3> frequency_hz{};
    std::array<double, 3> phase_rad{};
};

/// Draws all bursts of a record, in the order of their starts.
[[nodiscard]] std::vector<Burst> draw_bursts(const scenario::Scenario& scenario,
                                             const std::vector<scenario::PlannedSetUp>& plan,
                                             std::uint64_t seed);

/// Sum of the bursts, asked at rising instants.
class Disturbances {
public:
    explicit Disturbances(std::vector<Burst> bursts);

    /// Adds the bursts at an instant to the three axes.
    /// @param elapsed_s  since the start of the record; not less than in the last call.
    void add_to(std::array<double, 3>& axes_mgal, double elapsed_s);

private:
    std::vector<Burst> bursts_;
    std::size_t next_ = 0;
    std::vector<Burst> active_;
};

}  // namespace a351::sim::signal
