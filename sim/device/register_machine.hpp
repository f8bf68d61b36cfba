#pragma once
/// @file
/// The sensor as a machine of bytes in and bytes out: windows, registers, modes, frames; no I/O and
/// no clock; time is an argument.
///
/// Rules, times: M-A352AD10 data sheet, rev. 20251023, sections 5.2-5.17, 6.2, 7, tables 2.2, 2.4.
/// What it leaves open is decided where it is done: damaged commands (command_parser.hpp), frames
/// faster than the line (transmit_buffer.hpp), and here:
/// - A frame that carries FLAG counts as a read of FLAG: alarm bits show in one frame per excess.
///   Without FLAG in the frames they stand until FLAG is read.
/// - ACCL registers hold the acceleration whatever OUTPUT_SEL says; the tilt is in TILT (5.13).
///   Either is read with the same ND bit.
/// - Coefficients of the user's filter enter the flash when a user filter is selected; until then
///   power or a reset loses them.
/// - A backup or reset of the flash that power or a reset interrupts leaves it as it was.
/// - Rate 1000/s and the long-term filter together are not taken, whichever is written second.
/// - Sleep is entered from configuration mode only; start of sampling does not wait for anything.
/// - Samples come filtered: of the FIR filters only the start, the delay and a user filter's gain
///   are emulated.  MESMOD and TEMP_STABIL are kept and shown, but change no sample.

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
#include "sim/device/command_parser.hpp"
#include "sim/device/flash_memory.hpp"
#include "sim/device/long_term_filter.hpp"
#include "sim/device/register_file.hpp"
#include "sim/device/self_test.hpp"
#include "sim/device/transmit_buffer.hpp"
#include "sim/device/user_filter.hpp"
#include "sim/signal/sample_source.hpp"

namespace a351::sim {

struct MachineIdentity {
    std::string product_id = "A351AU10";     ///< Eight characters; the suffix is an assumption.
    std::string serial_number = "00000001";  ///< Eight characters.
    std::uint16_t firmware = 1;
    bool has_id_register = true;  ///< W0:4C, which the data sheet lacks, answers 5345.
};

/// What the emulated device of a profile calls itself unless told otherwise.
[[nodiscard]] std::string product_id_of(const wire::DeviceProfile& profile);

/// Other content of a register that holds settings.
struct RegisterChange {
    const wire::Register& reg;
    std::uint16_t value = 0;
    std::uint16_t mask = wire::kBothBytes;  ///< Bits that change.
};

class RegisterMachine {
public:
    /// The maxima of table 2.4 for power-on (900 ms), reset (970 ms) and wake-up (16 ms), less a
    /// margin: a host that waits for just the maximum must find the device ready, however late the
    /// command before its wait was looked at.
    static constexpr std::chrono::milliseconds kPowerOnTime{880};
    static constexpr std::chrono::milliseconds kResetTime{950};
    static constexpr std::chrono::milliseconds kWakeTime{10};

    /// Maxima of the same table; hosts ask whether it is done.
    static constexpr std::chrono::milliseconds kFilterTime{4};
    static constexpr std::chrono::milliseconds kUserFilterTime{100};
    static constexpr std::chrono::milliseconds kFlashBackupTime{310};
    static constexpr std::chrono::milliseconds kFlashResetTime{1900};

    /// Output of all axes while rate and filter do not fit: 100 g (7.7).
    static constexpr std::int32_t kAliasedCounts = 0x64000000;

    /// Told of the new content of the flash; false: it could not be kept, which FLASH_BU_ERR says.
    using FlashStore = std::function<bool(const FlashMemory&)>;

    /// Switched on at `power_on`; every later time is on the same clock and never before the last.
    RegisterMachine(const wire::DeviceProfile& profile, MachineIdentity identity,
                    Nanoseconds power_on, const FlashMemory& flash = {});

    /// Called after FLASH_BACKUP and FLASH_RST, and when a user filter is chosen whose coefficients
    /// are new.
    void on_flash_written(FlashStore store) { flash_store_ = std::move(store); }

    /// Takes bytes from the host, appends the answers.  Where the host cuts its bytes is
    /// indifferent.
    void receive(std::span<const std::byte> bytes, Nanoseconds now,
                 std::vector<std::byte>& answers);

    /// What ends by itself until `now` ends: start-up (with AUTO_START, in sampling), tests, flash.
    void pass_time(Nanoseconds now);

    /// One sample of the output rate.  In sampling mode it goes to the registers and, with
    /// UART_AUTO, as a frame to `frames`; otherwise nothing happens.  With EXT_SEL only the sample
    /// after an external_edge() counts; COUNT goes on in between.
    /// @return the values of the frame that was appended.
    std::optional<wire::BurstValues> sample(const SensorSample& sample,
                                            std::vector<std::byte>& frames);

    /// A sample of the output rate that nobody hears, as when the line is cut: COUNT goes on.
    void skip_sample();

    // What can happen to a device from outside; every time is on the clock of receive().
    void power_cycle(Nanoseconds now);        ///< Off and on again: boots for kPowerOnTime.
    void spontaneous_reset(Nanoseconds now);  ///< As SOFT_RST.
    void external_edge(Nanoseconds now);      ///< At pin EXT, of the polarity of EXT_POL; wakes.
    void fall_back_to_configuration();        ///< Stops sampling unasked.
    void raise_diagnostics(std::uint16_t diag_stat_bits);
    void clear_diagnostics();
    void jump_counter(std::uint16_t ticks);

    /// Goes to sampling with these settings changed; not while it starts up or sleeps.
    void apply_settings(std::span<const RegisterChange> changes, Nanoseconds now);

    /// From now on these bits of DIAG_STAT are what their test finds: self tests, FLASH_BU_ERR of
    /// flash commands, HARD_ERR and FLASH_ERR of every start-up; 0 heals.
    void fail_tests(std::uint16_t diag_stat_bits) { failing_ = diag_stat_bits; }

    void rename(MachineIdentity identity);  ///< Another unit in its place, with equal settings.

    [[nodiscard]] int baud() const;
    [[nodiscard]] bool is_sampling() const noexcept { return is_sampling_; }
    [[nodiscard]] bool is_asleep() const noexcept { return is_asleep_; }
    [[nodiscard]] int output_rate_hz() const;
    [[nodiscard]] const FlashMemory& flash() const noexcept { return flash_; }

    /// From the instant a sample stands for to the last byte of its frame on the line: group delay,
    /// internal delay, wait for earlier frames, frame length at the baud rate.
    [[nodiscard]] Nanoseconds frame_delay() const;

    /// Counts the entries into sampling mode: 0 before the first.
    [[nodiscard]] int sampling_run() const noexcept { return sampling_run_; }

    /// What a register holds, without what reading it would change.
    [[nodiscard]] std::uint16_t value_of(const wire::Register& reg) const {
        return registers_.at(reg);
    }

    /// Whole commands of the host, understood since the machine was made.
    [[nodiscard]] std::uint64_t command_count() const noexcept { return command_count_; }

private:
    struct FlashJob {
        std::uint16_t command = 0;  ///< Its bit of GLOB_CMD.
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
    void end_flash_job();
    void write_flash(const FlashMemory& content);
    void select_filter(std::uint16_t code);
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
    void store(const SensorSample& sample);
    void advance_counter(unsigned ticks);
    [[nodiscard]] std::array<std::int32_t, 3> filtered(const SensorSample& sample);
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
    bool is_soft_reset_ = false;  ///< The start-up was asked for by SOFT_RST.
    bool is_asleep_ = false;
    bool is_reduced_noise_ = false;
    SelfTest tests_;
    UserFilter user_filter_;
    FlashMemory::Coefficients coefficients_{};  ///< As written; in flash once selected.
    std::optional<FlashJob> flash_job_;

    bool is_sampling_ = false;
    bool is_aliased_ = false;
    bool is_triggered_ = false;   ///< An external edge waits for its sample.
    std::uint16_t new_data_ = 0;  ///< ND bits of FLAG.
    std::uint16_t alarms_ = 0;    ///< ALARM bits of FLAG.
    int transient_left_ = 0;      ///< Samples still to suppress.
    int sampling_run_ = 0;
    double user_gain_ = 1.0;
    LongTermFilter long_filter_;
    TransmitBuffer transmit_;
    std::optional<SensorSample> latest_;  ///< What the sensor feels, in any mode.
};

}  // namespace a351::sim
