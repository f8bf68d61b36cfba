#include "sim/device/register_machine.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace a351::sim::device {
namespace {

using wire::Register;
using wire::Window;

constexpr std::uint8_t kWriteBit = 0x80;
constexpr std::uint8_t kEvenAddress = 0xFE;
constexpr std::uint16_t kReducedNoise = 0x0010;  // SIG_CTRL: MESMOD_SEL (7.9).
constexpr std::uint16_t kReducedState = 0x1000;  // GLOB_CMD: MESMOD_STAT (7.14).

std::uint16_t with(std::uint16_t value, bool is_high_byte, std::uint8_t byte) {
    return static_cast<std::uint16_t>(is_high_byte ? (value & wire::kLowByte) | (byte << 8)
                                                   : (value & wire::kHighByte) | byte);
}

}  // namespace

Nanoseconds power_on_time(const wire::DeviceProfile& profile) noexcept {
    constexpr std::chrono::milliseconds kMargin{20};
    return profile.start_up - kMargin;
}

RegisterMachine::RegisterMachine(const wire::DeviceProfile& profile, MachineIdentity identity,
                                 Nanoseconds power_on, const FlashMemory& flash)
    : profile_(profile), identity_(std::move(identity)), flash_(flash), now_(power_on) {
    assert(identity_.product_id.size() == 8 && identity_.serial_number.size() == 8);
    reset(power_on + power_on_time(profile_));
}

void RegisterMachine::reset(Nanoseconds ready_at) {
    registers_ = RegisterFile();
    std::size_t saved = 0;
    for (const Register& reg : wire::kRegisters) {
        if (reg.is_saved_in_flash) registers_.at(reg) = flash_.settings[saved++];
    }
    put_identity();
    window_ = Window::w0;
    parser_.forget();
    ready_at_ = ready_at;
    is_starting_ = true;
    is_soft_reset_ = is_asleep_ = is_sampling_ = is_triggered_ = false;
    is_reduced_noise_ = has(wire::kSigCtrl, kReducedNoise);
    tests_.abort();
    user_filter_.reset();
    flash_job_.reset();
    new_data_ = alarms_ = 0;
    coefficients_ = flash_.coefficients;
    put_gain_in_force();
    filter_ready_at_ = now_;
    check_aliasing();
}

void RegisterMachine::put_identity() {
    registers_.put_text(kProductId, identity_.product_id);
    registers_.at(kVersion) = identity_.firmware;
    registers_.put_text(kSerial, identity_.serial_number);
    registers_.at(wire::kId) = identity_.has_id_register ? wire::kId.default_value : 0;
}

void RegisterMachine::receive(std::span<const std::byte> bytes, Nanoseconds now,
                              std::vector<std::byte>& answers) {
    pass_time(now);
    for (const std::byte byte : bytes) {
        if (is_asleep_) return;  // The UART sleeps too (5.14).
        const std::optional<HostCommand> command = parser_.next(byte, now_);
        if (!command) continue;
        ++command_count_;
        if ((command->address & kWriteBit) == 0) {
            read(command->address, answers);
        } else {
            write(command->address & static_cast<std::uint8_t>(~kWriteBit), command->value,
                  answers);
        }
    }
}

void RegisterMachine::pass_time(Nanoseconds now) {
    now_ = now;
    if (is_starting_ && now_ >= ready_at_) end_start_up();
    user_filter_.end_due(now_, coefficients_, (failing_ & wire::kDiagFlashError) == 0);
    if (flash_job_ && now_ >= flash_job_->ends_at) {
        write_flash({std::exchange(flash_job_, std::nullopt)->settings, flash_.coefficients});
    }
    raise_diagnostics(tests_.end_due(now_, failing_, latest_, profile_));
}

void RegisterMachine::end_start_up() {
    is_starting_ = is_soft_reset_ = false;
    raise_diagnostics(failing_ & (wire::kDiagHardError | wire::kDiagFlashError));
    if (has(wire::kUartCtrl, wire::kUartAutoStart) && has(wire::kUartCtrl, wire::kUartAuto))
        start_sampling();
}

/// Answers a read.  While the device starts up or wakes, only GLOB_CMD answers.
void RegisterMachine::read(std::uint8_t address, std::vector<std::byte>& answers) {
    const Register* reg = wire::register_at(window_, address & kEvenAddress);
    if (now_ < ready_at_ && reg != &wire::kGlobCmd) return;
    const std::uint16_t value = reg == nullptr ? std::uint16_t{0} : answer_of(*reg);
    answers.push_back(std::byte{address});
    answers.push_back(static_cast<std::byte>(value >> 8));
    answers.push_back(static_cast<std::byte>(value & 0xFF));
    answers.push_back(wire::kEndByte);
    if (window_ == Window::w0) clear_after_read(address & kEvenAddress);
}

std::uint16_t RegisterMachine::answer_of(const Register& reg) const {
    if (&reg == &wire::kFlag) return flag();
    if (&reg == &wire::kGlobCmd) return command_state();
    if (&reg == &kFirCommand) return user_filter_.command();
    if (&reg == &kFirData) return user_filter_.data();
    if (&reg == &kFirAddress) return user_filter_.address();
    const std::uint16_t value = registers_.at(reg);
    if (&reg == &wire::kMscCtrl) return with(value, true, tests_.running());
    if (&reg == &wire::kFilterCtrl && now_ < filter_ready_at_) return value | wire::kFilterBusy;
    return value;
}

/// Returns GLOB_CMD; the bit of a command reads 1 while the command runs.
std::uint16_t RegisterMachine::command_state() const {
    unsigned state = flash_job_ ? flash_job_->command : 0U;
    if (now_ < ready_at_) state |= wire::kGlobNotReady;
    if (is_soft_reset_) state |= wire::kGlobSoftReset;
    if (is_reduced_noise_) state |= kReducedState;
    return static_cast<std::uint16_t>(state);
}

void RegisterMachine::write(std::uint8_t address, std::uint8_t value,
                            std::vector<std::byte>& frames) {
    const Register* reg = wire::register_at(window_, address & kEvenAddress);
    if (reg == nullptr) return;
    const bool is_high_byte = (address & 1U) != 0;
    if ((reg->writable_bytes & (is_high_byte ? wire::kHighByte : wire::kLowByte)) == 0) return;
    if (reg->name == wire::kWinCtrl.name) {
        if (value > 1) return;
        window_ = static_cast<Window>(value);
        registers_.at(wire::kWinCtrl) = value;
        registers_.at(*wire::register_at(Window::w1, wire::kWinCtrl.address)) = value;
        return;
    }
    if (now_ < ready_at_) return;
    if (reg == &wire::kModeCtrl) return write_mode(value);
    if (reg == &wire::kGlobCmd) return write_command(value);
    if (reg == &kBurst) {
        const bool is_manual = !has(wire::kUartCtrl, wire::kUartAuto);
        if (const auto shape = layout(); value == 0 && is_sampling_ && is_manual && shape)
            wire::append_frame(*shape, take_values(*shape), frames);
        return;
    }
    if (!is_sampling_) write_register(*reg, is_high_byte, value);
}

void RegisterMachine::write_mode(std::uint8_t value) {
    const auto command = static_cast<std::uint16_t>((value & 0x03U) << 8U);
    if (command == wire::kModeCmdConfig) return fall_back_to_configuration();
    if (is_sampling_) return;
    if (command == wire::kModeCmdSampling) start_sampling();
    if (command == wire::kModeCmdSleep) is_asleep_ = true;
}

void RegisterMachine::write_command(std::uint8_t value) {
    if ((value & wire::kGlobSoftReset) != 0) {
        reset(now_ + kResetTime);
        is_soft_reset_ = true;
        return;
    }
    if (is_sampling_ || flash_job_) return;
    if ((value & wire::kGlobFlashBackup) != 0) {
        flash_job_ = FlashJob{wire::kGlobFlashBackup, {}, now_ + kFlashBackupTime};
        std::size_t saved = 0;
        for (const Register& reg : wire::kRegisters) {
            if (reg.is_saved_in_flash) flash_job_->settings[saved++] = registers_.at(reg);
        }
    } else if ((value & wire::kGlobFlashReset) != 0) {
        flash_job_ = FlashJob{wire::kGlobFlashReset, FlashMemory::factory_settings(),
                              now_ + kFlashResetTime};
    }
}

void RegisterMachine::write_flash(const FlashMemory& content) {
    const bool is_kept =
        (failing_ & kDiagFlashBackup) == 0 && (!flash_store_ || flash_store_(content));
    if (!is_kept) return raise_diagnostics(kDiagFlashBackup);
    flash_ = content;
}

/// Writes one byte of a register.  A value that the data sheet reserves is ignored.
void RegisterMachine::write_register(const Register& reg, bool is_high_byte, std::uint8_t value) {
    if (&reg == &kFirCommand) return user_filter_.start(value & 0x03U, now_);
    if (&reg == &kFirData) return user_filter_.set_data(value);
    if (&reg == &wire::kMscCtrl && is_high_byte) return tests_.start(value, now_);
    const std::uint16_t settable =
        &reg == &wire::kFilterCtrl ? wire::kFilterSelect : reg.defined_bits;
    const std::uint16_t next = with(answer_of(reg), is_high_byte, value) & settable;
    if (&reg == &wire::kMscCtrl) {
        registers_.at(reg) = next & wire::kLowByte;
    } else if (may_hold(profile_, reg, next)) {
        put_register(reg, next);
    }
}

void RegisterMachine::put_register(const Register& reg, std::uint16_t value) {
    if (&reg == &kFirAddress) return user_filter_.set_address(value);
    const std::uint16_t before = std::exchange(registers_.at(reg), value);
    const bool is_of_pair = &reg == &wire::kSmplCtrl || &reg == &kLongFilter;
    if (is_of_pair && !has_rate_for_long_filter(profile_, registers_)) {
        registers_.at(reg) = before;
        return;
    }
    if (&reg == &wire::kFilterCtrl) select_filter();
    if (&reg == &wire::kSmplCtrl || &reg == &wire::kFilterCtrl) check_aliasing();
}

void RegisterMachine::select_filter() {
    const bool is_user = filter().is_user;
    filter_ready_at_ = now_ + (is_user ? kUserFilterTime : kFilterTime);
    put_gain_in_force();
    if (is_user && coefficients_ != flash_.coefficients) {
        write_flash({flash_.settings, coefficients_});
    }
}

void RegisterMachine::put_gain_in_force() {
    user_gain_ = filter().is_user ? constant_gain(coefficients_, filter().taps) : 1.0;
}

/// Updates is_aliased_.  The external trigger may be used with any filter (note at table 5.4).
void RegisterMachine::check_aliasing() {
    const auto& rates = filter().allowed_rates_hz;
    is_aliased_ = !has(wire::kMscCtrl, wire::kMscExternalTrigger) &&
                  std::ranges::count(rates, output_rate_hz()) == 0;
}

int RegisterMachine::baud() const {
    return *decoded(profile_.baud_rates, registers_.at(wire::kUartCtrl) >> 8U);
}

int RegisterMachine::output_rate_hz() const {
    return *decoded(profile_.output_rates_hz, registers_.at(wire::kSmplCtrl) >> 8U);
}

void RegisterMachine::power_cycle(Nanoseconds now) {
    pass_time(now);
    reset(now + power_on_time(profile_));
}

void RegisterMachine::spontaneous_reset(Nanoseconds now) {
    pass_time(now);
    reset(now + kResetTime);
}

void RegisterMachine::external_edge(Nanoseconds now) {
    pass_time(now);
    is_triggered_ = is_sampling_ && has(wire::kMscCtrl, wire::kMscExternalTrigger);
    if (!is_asleep_) return;
    is_asleep_ = false;
    parser_.forget();
    ready_at_ = now + kWakeTime;
}

void RegisterMachine::fall_back_to_configuration() {
    is_sampling_ = false;
    registers_.at(wire::kModeCtrl) = wire::kModeStatConfig;
}

void RegisterMachine::raise_diagnostics(std::uint16_t diag_stat_bits) {
    registers_.at(wire::kDiagStat) |= diag_stat_bits;
}

void RegisterMachine::apply_settings(std::span<const RegisterChange> changes, Nanoseconds now) {
    pass_time(now);
    if (now_ < ready_at_ || is_asleep_) return;
    fall_back_to_configuration();
    for (const RegisterChange& change : changes) {
        const unsigned kept = registers_.at(change.reg) & ~unsigned{change.mask};
        put_register(change.reg, static_cast<std::uint16_t>(kept | (change.value & change.mask)));
    }
    start_sampling();
}

void RegisterMachine::rename(MachineIdentity identity) {
    identity_ = std::move(identity);
    put_identity();
}

}  // namespace a351::sim::device
