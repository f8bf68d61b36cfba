#pragma once
/// @file
/// The sensor as a machine of bytes in and bytes out: command parser, windows, registers, modes,
/// frames.  No I/O and no clock; time is an argument.
///
/// Rules and times: M-A352AD10 data sheet, rev. 20251023, sections 5.2-5.6, 5.17, 6.2, 7, table
/// 2.2.  What the data sheet leaves open (damaged commands) is said at the function.  Flash, user
/// filter, tilt, alarms, offsets and the long-term filter can be written and read back but have no
/// effect; sleep is not entered.

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/registers.hpp"
#include "sim/signal/sample_source.hpp"

namespace a351::sim {

struct MachineIdentity {
    std::string product_id = "A351AU10";     ///< Eight characters; the suffix is an assumption.
    std::string serial_number = "00000001";  ///< Eight characters.
    std::uint16_t firmware = 1;
};

/// What the emulated device of a profile calls itself unless told otherwise.
[[nodiscard]] std::string product_id_of(const wire::DeviceProfile& profile);

class RegisterMachine {
public:
    static constexpr std::chrono::milliseconds kPowerOnTime{900};  ///< Table 2.2, maxima.
    static constexpr std::chrono::milliseconds kResetTime{970};
    static constexpr std::chrono::milliseconds kFilterTime{4};
    static constexpr std::chrono::milliseconds kUserFilterTime{100};
    static constexpr std::chrono::milliseconds kFlashTestTime{5};
    static constexpr std::chrono::milliseconds kSelfTestTime{200};
    static constexpr std::chrono::seconds kSensitivityTestTime{10};       ///< Typical.
    static constexpr std::chrono::milliseconds kPartialCommandLife{100};  ///< Assumed.

    /// Output of all axes while rate and filter do not fit: 100 g (5.17).
    static constexpr std::int32_t kAliasedCounts = 0x64000000;

    /// Switched on at `power_on`; every later time is on the same clock and never before the last.
    RegisterMachine(const wire::DeviceProfile& profile, MachineIdentity identity,
                    Nanoseconds power_on);

    /// Takes bytes from the host, appends the answers.  Where the host cuts its bytes is
    /// indifferent.  A CR at the start of a command is skipped; if the third byte is no CR, the
    /// first is dropped and the rest looked at again; a partial command is forgotten after
    /// kPartialCommandLife.
    void receive(std::span<const std::byte> bytes, Nanoseconds now,
                 std::vector<std::byte>& answers);

    /// One sample of the output rate.  In sampling mode it goes to the registers and, with
    /// UART_AUTO, as a frame to `frames`; otherwise nothing happens.
    /// @return the values of the frame that was appended.
    std::optional<wire::BurstValues> sample(const SensorSample& sample,
                                            std::vector<std::byte>& frames);

    /// A sample of the output rate that nobody hears, as when the line is cut: COUNT goes on.
    void skip_sample();

    // What can happen to a device from outside; every time is on the clock of receive().
    void power_cycle(Nanoseconds now);        ///< Off and on again: boots for kPowerOnTime.
    void spontaneous_reset(Nanoseconds now);  ///< As SOFT_RST.
    void fall_back_to_configuration();        ///< Stops sampling unasked.
    void raise_diagnostics(std::uint16_t diag_stat_bits);
    void jump_counter(std::uint16_t ticks);
    void rename(MachineIdentity identity);  ///< Another unit in its place, with equal settings.

    [[nodiscard]] int baud() const noexcept;
    [[nodiscard]] bool is_sampling() const noexcept { return is_sampling_; }
    [[nodiscard]] int output_rate_hz() const noexcept;

    /// From the instant a sample stands for to the last byte of its frame on the line: group delay,
    /// internal delay, frame length at the baud rate.
    [[nodiscard]] Nanoseconds frame_delay() const;

    /// Counts the entries into sampling mode: 0 before the first.
    [[nodiscard]] int sampling_run() const noexcept { return sampling_run_; }

    /// Whole commands understood since power-on.
    [[nodiscard]] std::uint64_t command_count() const noexcept { return command_count_; }

private:
    using Bank = std::array<std::uint16_t, 64>;

    void reset(Nanoseconds ready_at);
    void execute(std::uint8_t address, std::uint8_t value, std::vector<std::byte>& answers);
    void read(std::uint8_t address, std::vector<std::byte>& answers);
    void write(std::uint8_t address, std::uint8_t value, std::vector<std::byte>& frames);
    void write_mode(std::uint8_t value);
    void write_register(const wire::Register& reg, bool is_high_byte, std::uint8_t value);
    void start_tests(std::uint8_t high_byte);
    void update_busy_bits();
    void check_aliasing();
    void start_sampling();
    void store(const SensorSample& sample);
    [[nodiscard]] wire::BurstValues take_values();
    void advance_counter(unsigned ticks);
    void put_identity();
    void put_text(std::uint8_t first_address, const std::string& text);
    [[nodiscard]] std::uint16_t flag() const;
    [[nodiscard]] std::uint16_t& at(const wire::Register& reg);
    [[nodiscard]] std::uint16_t value_of(const wire::Register& reg) const;
    [[nodiscard]] const wire::FilterSpec& filter() const;

    const wire::DeviceProfile& profile_;
    MachineIdentity identity_;
    std::array<Bank, 2> banks_{};
    wire::Window window_ = wire::Window::w0;
    std::vector<std::byte> partial_;
    Nanoseconds partial_since_{0};
    Nanoseconds now_{0};
    Nanoseconds ready_at_{0};
    Nanoseconds filter_ready_at_{0};
    Nanoseconds tests_end_at_{0};
    bool is_sampling_ = false;
    bool is_aliased_ = false;
    std::uint16_t new_data_ = 0;  ///< ND bits of FLAG.
    int transient_left_ = 0;      ///< Samples still to suppress.
    int sampling_run_ = 0;
    std::uint64_t command_count_ = 0;
};

}  // namespace a351::sim
