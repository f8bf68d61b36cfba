#pragma once
/// @file
/// The sensor as a machine that takes and gives bytes: windows, registers, modes, frames.  No I/O
/// and no clock: time is an argument.
///
/// Rules, times: M-A352AD10 data sheet, rev. 20251023, sections 5.2-5.17, 6.2, 7, tables 2.2, 2.4.
/// It leaves some cases open.  See uart.hpp for damaged commands and for frames faster than the
/// line.  The others are decided here:
/// - A frame that carries FLAG counts as a read of FLAG: alarm bits show in one frame per excess.
///   If frames do not carry FLAG, the bits stay set until FLAG is read.
/// - ACCL registers hold the acceleration for any OUTPUT_SEL; the tilt is in TILT (5.13).
///   Reading either clears the same ND bit.
/// - Coefficients of the user filter enter the flash when a user filter is selected; until then
///   a power failure or a reset loses them.
/// - A backup or reset of the flash that a power failure or a reset interrupts changes nothing.
/// - Rate 1000/s and the long-term filter exclude each other; the second setting is ignored.
/// - Sleep is entered from configuration mode only; the start of sampling does not wait.
/// - Samples come filtered: of the FIR filters only the start, the delay and a user filter's gain
///   are emulated.  MESMOD and TEMP_STABIL are stored and shown, but change no sample.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/registers.hpp"
#include "sim/device/flash_memory.hpp"
#include "sim/device/register_file.hpp"
#include "sim/device/self_test.hpp"
#include "sim/device/signal_path.hpp"
#include "sim/device/uart.hpp"
#include "sim/signal/sample_source.hpp"

namespace a351::sim::device {

struct MachineIdentity {
    std::string product_id = "A351AU10";     ///< Eight characters; the suffix is an assumption.
    std::string serial_number = "00000001";  ///< Eight characters.
    std::uint16_t firmware = 1;
    bool has_id_register = true;  ///< W0:4C, not in the data sheet, reads 5345 hexadecimal.

    bool operator==(const MachineIdentity&) const = default;
};

/// Returns the time from power-on until the device answers: the longest one of the profile, minus a
/// margin.  A host that waits for just the longest must find the device ready, even if the emulator
/// handled the command before that wait late.
[[nodiscard]] Nanoseconds power_on_time(const wire::DeviceProfile& profile) noexcept;

/// A change of a register that holds settings.
struct RegisterChange {
    const wire::Register& reg;
    std::uint16_t value = 0;
    std::uint16_t mask = wire::kBothBytes;  ///< Bits that change.
};

class RegisterMachine {
public:
    /// Times after reset (970 ms) and wake-up (16 ms): the maxima of table 2.4, minus the margin of
    /// power_on_time().
    static constexpr std::chrono::milliseconds kResetTime{950};
    static constexpr std::chrono::milliseconds kWakeTime{10};

    /// Times of commands: maxima of the same table, without a margin, as hosts ask for the end.
    static constexpr std::chrono::milliseconds kFilterTime{4};
    static constexpr std::chrono::milliseconds kUserFilterTime{100};
    static constexpr std::chrono::milliseconds kFlashBackupTime{310};
    static constexpr std::chrono::milliseconds kFlashResetTime{1900};

    /// Output of all axes while rate and filter do not fit, counts: 100 g (7.7).
    static constexpr std::int32_t kAliasedCounts = 0x64000000;

    /// Stores the new content of the flash.  If it returns false, FLASH_BU_ERR is raised.
    using FlashStore = std::function<bool(const FlashMemory&)>;

    /// Switches the device on at `power_on`.  All later times are on the same clock and must not
    /// run backwards.
    RegisterMachine(const wire::DeviceProfile& profile, MachineIdentity identity,
                    Nanoseconds power_on, const FlashMemory& flash = {});

    /// Sets the store that is called after FLASH_BACKUP and FLASH_RST, and when a user filter with
    /// new coefficients is selected.
    void on_flash_written(FlashStore store) { flash_store_ = std::move(store); }

    /// Takes bytes from the host and appends the answers.  A command may be split over calls.
    void receive(std::span<const std::byte> bytes, Nanoseconds now,
                 std::vector<std::byte>& answers);

    /// Ends everything that is finished by `now`: start-up (with AUTO_START, in sampling mode),
    /// tests, flash commands.
    void pass_time(Nanoseconds now);

    /// Takes one sample at the output rate.  In sampling mode it is put into the registers and,
    /// with UART_AUTO, appended to `frames` as a frame; otherwise nothing happens.  With EXT_SEL
    /// only the sample after an external_edge() is used; COUNT advances in between.
    /// @return the values of the frame that was appended, if any.
    std::optional<wire::BurstValues> sample(const signal::SensorSample& sample,
                                            std::vector<std::byte>& frames);

    /// Skips one sample at the output rate, as when the line is cut: only COUNT advances.
    void skip_sample();

    // Events from outside; every time is on the clock of receive().
    void power_cycle(Nanoseconds now);        ///< Switches off and on: start-up of power_on_time().
    void spontaneous_reset(Nanoseconds now);  ///< Acts as SOFT_RST.
    void external_edge(Nanoseconds now);      ///< Edge at pin EXT, polarity of EXT_POL; wakes it.
    void fall_back_to_configuration();        ///< Stops sampling without a command.
    void raise_diagnostics(std::uint16_t diag_stat_bits);
    void clear_diagnostics() { registers_.at(wire::kDiagStat) = 0; }
    void jump_counter(unsigned ticks);

    /// Changes these settings and starts sampling; does nothing during start-up or sleep.
    void apply_settings(std::span<const RegisterChange> changes, Nanoseconds now);

    /// Sets the bits of DIAG_STAT that tests raise from now on: self tests, flash commands
    /// (FLASH_BU_ERR) and every start-up (HARD_ERR, FLASH_ERR).  0 ends this.
    void fail_tests(std::uint16_t diag_stat_bits) { failing_ = diag_stat_bits; }

    void rename(MachineIdentity identity);  ///< Replaces the unit by one with equal settings.

    [[nodiscard]] int baud() const;
    [[nodiscard]] bool is_sampling() const noexcept { return is_sampling_; }
    [[nodiscard]] bool is_asleep() const noexcept { return is_asleep_; }
    [[nodiscard]] int output_rate_hz() const;
    [[nodiscard]] const FlashMemory& flash() const noexcept { return flash_; }

    /// Returns the time from the instant that a sample represents to the last byte of its frame on
    /// the line: group delay, internal delay, wait for earlier frames, length at the baud rate.
    [[nodiscard]] Nanoseconds frame_delay() const;

    /// Returns the number of entries into sampling mode so far.
    [[nodiscard]] int sampling_run() const noexcept { return sampling_run_; }

    /// Returns the content of a register without the side effects of a read.
    [[nodiscard]] std::uint16_t value_of(const wire::Register& reg) const {
        return registers_.at(reg);
    }

    /// Returns the number of complete commands received since the machine was made.
    [[nodiscard]] std::uint64_t command_count() const noexcept { return command_count_; }

private:
    struct FlashJob {
        std::uint16_t command = 0;  ///< Bit of GLOB_CMD.
        FlashMemory::Settings settings{};
        Nanoseconds ends_at{0};
    };

    // Registers: register_machine.cpp.
    void reset(Nanoseconds ready_at);
    void end_start_up();
    void read(std::uint8_t address, std::vector<std::byte>& answers);
    void clear_after_read(std::uint8_t address);
    [[nodiscard]] std::uint16_t answer_of(const wire::Register& reg) const;
    void write(std::uint8_t address, std::uint8_t value, std::vector<std::byte>& frames);
    void write_mode(std::uint8_t value);
    void write_command(std::uint8_t value);
    void write_register(const wire::Register& reg, bool is_high_byte, std::uint8_t value);
    void put_register(const wire::Register& reg, std::uint16_t value);
    void write_flash(const FlashMemory& content);
    void select_filter();
    void put_gain_in_force();
    void check_aliasing();
    void put_identity();
    [[nodiscard]] std::uint16_t command_state() const;
    [[nodiscard]] bool has(const wire::Register& reg, std::uint16_t bits) const {
        return (registers_.at(reg) & bits) != 0;
    }

    // Samples: register_machine_samples.cpp.
    void start_sampling();
    [[nodiscard]] bool begin_sample();
    void store(const signal::SensorSample& sample);
    [[nodiscard]] std::array<std::int32_t, 3> filtered(const signal::SensorSample& sample);
    [[nodiscard]] wire::BurstValues take_values(const wire::BurstLayout& layout);
    [[nodiscard]] std::uint16_t flag() const;
    [[nodiscard]] std::optional<wire::BurstLayout> layout() const;
    [[nodiscard]] bool sends_tilt(std::size_t axis) const;
    [[nodiscard]] const wire::FilterSpec& filter() const;
    [[nodiscard]] std::int64_t frame_bits() const;

    const wire::DeviceProfile& profile_;
    MachineIdentity identity_;
    FlashMemory flash_;
    FlashStore flash_store_;
    std::uint16_t failing_ = 0;

    RegisterFile registers_;
    wire::Window window_ = wire::Window::w0;
    CommandParser parser_;
    std::uint64_t command_count_ = 0;
    Nanoseconds now_{0};
    Nanoseconds ready_at_{0};
    Nanoseconds filter_ready_at_{0};
    bool is_starting_ = true;
    bool is_soft_reset_ = false;  ///< SOFT_RST caused the start-up.
    bool is_asleep_ = false;
    bool is_reduced_noise_ = false;
    SelfTest tests_;
    UserFilter user_filter_;
    FlashMemory::Coefficients coefficients_{};  ///< Written by the host; in flash once selected.
    std::optional<FlashJob> flash_job_;

    bool is_sampling_ = false;
    bool is_aliased_ = false;
    bool is_triggered_ = false;   ///< An external edge has occurred; its sample is next.
    std::uint16_t new_data_ = 0;  ///< ND bits of FLAG.
    std::uint16_t alarms_ = 0;    ///< ALARM bits of FLAG.
    int transient_left_ = 0;      ///< Samples still to suppress.
    int sampling_run_ = 0;
    double user_gain_ = 1.0;
    LongTermFilter long_filter_;
    TransmitBuffer transmit_;
    std::optional<signal::SensorSample> latest_;  ///< Newest sample of the sensor, in any mode.
};

}  // namespace a351::sim::device
