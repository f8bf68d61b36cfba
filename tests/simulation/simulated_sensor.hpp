#pragma once
/// @file
/// The emulated sensor, its line and its port, without a terminal: the reader's calls serve the
/// device in simulated time.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/source/port.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/device/register_machine.hpp"
#include "sim/line/fault_injector.hpp"
#include "sim/line/line.hpp"
#include "tests/simulation/host.hpp"
#include "tests/simulation/schedule.hpp"

namespace a351::simulation {

/// Samples that are known by the value of any of their axes: a multiple of their number plus noise,
/// so that records are about as long as in the field.
class NumberedSamples final : public sim::signal::SampleSource {
public:
    static constexpr int kRate_hz = 50;

    explicit NumberedSamples(UtcTime start) : start_(start) {}
    [[nodiscard]] int rate_hz() const noexcept override { return kRate_hz; }
    [[nodiscard]] std::optional<UtcTime> next_instant() const override { return instant(next_); }
    [[nodiscard]] sim::signal::TimedSample next() override;

    /// Leaves out all samples before `time`, as while the sensor has no power.
    void skip_to(UtcTime time);

    [[nodiscard]] UtcTime instant(std::int64_t number) const {
        return start_ + number * std::chrono::milliseconds(1000 / kRate_hz);
    }
    [[nodiscard]] static std::array<std::int32_t, 3> axes(std::int64_t number);
    /// Returns the number of a sample by its value on an axis; std::nullopt if no sample has it.
    [[nodiscard]] static std::optional<std::int64_t> number(std::size_t axis, std::int32_t counts);
    [[nodiscard]] static std::int32_t temperature(std::int64_t number);

private:
    UtcTime start_;
    std::int64_t next_ = 0;
};

class SimulatedSensor {
public:
    /// Fate of each sample, by its number.
    enum class Fate : std::uint8_t { not_sent, lost, damaged, doubtful, arrived };

    SimulatedSensor(std::uint64_t seed, Schedule& schedule, Host& host,
                    const sim::scenario::LineParameters& line);

    void apply(const sim::line::Fault& fault);
    /// Passes the time in which the host does not listen: the bytes of the sensor are lost.
    void pass_unheard();
    /// Passes the time up to now without power.
    void pass_without_power();

    /// Returns a port that is gone once the plug was out.
    /// @throws source::PortError  the plug is out.
    std::unique_ptr<daemon::source::Port> open(int baud);

    /// Returns true if a frame of a sample arrived whole.
    [[nodiscard]] bool may_be_archived(std::int64_t number) const {
        return number >= 0 && number < samples() &&
               fates_[static_cast<std::size_t>(number)] >= Fate::doubtful;
    }
    [[nodiscard]] std::int64_t samples() const { return static_cast<std::int64_t>(fates_.size()); }
    /// Returns the number of the last sample that arrived whole, and when.
    [[nodiscard]] std::optional<std::pair<std::int64_t, Nanoseconds>> last_arrival() const {
        return last_arrival_;
    }
    [[nodiscard]] bool is_plugged_in() const { return !hang_up_; }

private:
    class PluggedPort;
    [[nodiscard]] sim::device::Instant instant() const;
    void serve();
    void discard();
    [[nodiscard]] Nanoseconds next_event() const;
    void settle(const sim::truth::Record& record);

    Schedule& schedule_;
    Host& host_;
    const wire::DeviceProfile& profile_;
    NumberedSamples samples_;
    sim::device::RegisterMachine machine_;
    sim::device::DeviceStream device_;
    sim::line::Line line_;
    sim::line::FaultInjector injector_;
    std::optional<sim::line::FaultInjector::HangUp> hang_up_;
    int plugged_in_ = 0;  ///< Number of times.
    std::vector<Fate> fates_;
    std::optional<std::pair<std::int64_t, Nanoseconds>> last_arrival_;
};

}  // namespace a351::simulation
