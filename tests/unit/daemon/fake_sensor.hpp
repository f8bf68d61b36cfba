#pragma once
/// @file
/// A sensor on a pseudo-terminal: registers from scripted_registers.hpp, frames in real time.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "protocol/wire/burst_frame.hpp"
#include "tests/unit/daemon/pty.hpp"
#include "tests/unit/wire/scripted_registers.hpp"

namespace a351 {

class FakeSensor {
public:
    std::atomic<bool> is_mute{false};       ///< Neither answers nor sends.
    std::atomic<bool> is_loose{false};      ///< Its plug is loose: it samples, but no byte passes.
    std::atomic<bool> is_idle{false};       ///< Answers, but sends no frame.
    std::atomic<bool> does_babble{false};   ///< Sends bytes that are no frames.
    std::atomic<int> counts_per_frame{80};  ///< 80 at 50 samples/s; 40 as if somebody had set 100.
    std::atomic<std::int32_t> frames_sent{0};

    explicit FakeSensor(std::string serial_number = "00000042") {
        const std::string identity = "A351AU10" + std::string(2, '\0') + serial_number;
        for (std::size_t i = 0; i < identity.size(); i += 2) {
            const auto low = static_cast<unsigned char>(identity[i]);
            const auto high = static_cast<unsigned char>(identity[i + 1]);
            registers_.values[{wire::Window::w1, static_cast<std::uint8_t>(0x6A + i)}] =
                static_cast<std::uint16_t>(high << 8 | low);
        }
        thread_ = std::thread([this] { run(); });
    }
    ~FakeSensor() { switch_off(); }
    FakeSensor(const FakeSensor&) = delete;
    FakeSensor& operator=(const FakeSensor&) = delete;

    [[nodiscard]] const std::string& path() const noexcept { return pty_.path(); }

    /// Closes the terminal, as if the adapter were pulled out.
    void switch_off() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        pty_.close_master();
    }

    /// Starts sampling without a command, as after an outage of the host.
    void start_sampling() {
        const std::lock_guard lock(mutex_);
        registers_.is_sampling = true;
    }

    /// Switches the sensor off and on: it waits for commands, and its counter is 0.
    void lose_power() {
        const std::lock_guard lock(mutex_);
        registers_.is_sampling = false;
        count_ = 0;
    }

    /// Sets bits of DIAG_STAT, as a start-up test that failed.
    void raise(std::uint16_t diag_stat_bits) {
        const std::lock_guard lock(mutex_);
        registers_.set(wire::kDiagStat, diag_stat_bits);
    }

    /// Sets the bits of DIAG_STAT that each start-up raises from now on.
    void fail_start_ups(std::uint16_t diag_stat_bits) {
        const std::lock_guard lock(mutex_);
        registers_.start_up_faults = diag_stat_bits;
    }

    /// Loses the next answers to reads of a register.
    void lose_answers(const wire::Register& reg, int count) {
        const std::lock_guard lock(mutex_);
        registers_.unanswered[wire::ScriptedRegisters::key(reg)] = count;
    }

    [[nodiscard]] bool is_sampling() const {
        const std::lock_guard lock(mutex_);
        return registers_.is_sampling;
    }

    /// Returns the values of the i-th frame sent.
    [[nodiscard]] static wire::BurstValues values(std::int32_t i) {
        wire::BurstValues values;
        values.temperature = 1000 + i;
        values.axes = {i, -i, (std::int32_t{1} << 24) + i};
        values.count = static_cast<std::uint16_t>(80 * (i + 1));
        return values;
    }

private:
    void run() {
        using Clock = std::chrono::steady_clock;
        constexpr std::chrono::milliseconds kPeriod{20};
        auto due = Clock::now();
        while (!stop_) {
            const auto bytes = pty_.read(std::chrono::milliseconds(2));
            if (is_mute) continue;
            const std::lock_guard lock(mutex_);
            const bool was_sampling = registers_.is_sampling;
            if (!is_loose) registers_.take(bytes);
            wire::Bytes output = std::exchange(registers_.output, {});
            if (!was_sampling) due = Clock::now() + kPeriod;
            if (registers_.is_sampling && !is_idle && Clock::now() >= due) {
                due += kPeriod;
                wire::BurstValues frame = values(frames_sent++);
                frame.count = static_cast<std::uint16_t>(count_ += counts_per_frame);
                wire::append_frame(wire::BurstLayout::recommended(), frame, output);
                if (does_babble) output.assign(24, std::byte{0x55});
            }
            if (!output.empty() && !is_loose) pty_.write(output);
        }
    }

    Pty pty_;
    mutable std::mutex mutex_;
    wire::ScriptedRegisters registers_;
    int count_ = 0;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

/// Waits until `claim` is true.  @return false if it is not true within `limit` of real time
template <class Claim>
[[nodiscard]] bool eventually(Claim claim, std::chrono::seconds limit = std::chrono::seconds(20)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!claim()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

}  // namespace a351
