#pragma once
/// @file
/// The emulated sensor in simulated time: takes samples from their source at their instants, hands
/// them to the register machine and sends its bytes when they are due.  No I/O and no clock.

#include <optional>
#include <span>
#include <vector>

#include "sim/device/line_device.hpp"
#include "sim/device/register_machine.hpp"
#include "sim/signal/sample_source.hpp"

namespace a351::sim::device {

/// The grid of samples is fixed in simulated time.  A sample due in sampling mode is sent; in other
/// modes samples are taken but not sent.
///
/// If the output rate is above the source's, of which it must be a multiple, each sample is
/// repeated.  A new output rate starts with the source's next sample.
class DeviceStream final : public LineDevice {
public:
    /// Both arguments must outlive this.
    DeviceStream(signal::SampleSource& source, RegisterMachine& machine);

    void receive(std::span<const std::byte> bytes, const Instant& now, LineSink& line) override;
    void advance_to(const Instant& now, LineSink& line) override;
    [[nodiscard]] std::optional<UtcTime> next_due() const override;
    [[nodiscard]] int baud() const override { return machine_.baud(); }

private:
    [[nodiscard]] bool is_holding() const;
    [[nodiscard]] UtcTime instant() const;
    void send_sample(UtcTime due, LineSink& line);

    signal::SampleSource& source_;
    RegisterMachine& machine_;
    std::optional<signal::TimedSample> held_;  ///< Sample whose repeats are not all sent.
    int held_rate_hz_ = 0;                     ///< Output rate for which held_ is valid.
    int repeat_ = 0;                           ///< Next repeat of held_.
    std::vector<std::byte> bytes_;             ///< A member to reuse its memory.
};

}  // namespace a351::sim::device
