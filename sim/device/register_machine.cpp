#include "sim/device/register_machine.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace a351::sim {
namespace {

using wire::Register;
using wire::Window;

constexpr std::byte kCarriageReturn{0x0D};
constexpr std::uint8_t kWriteBit = 0x80;
constexpr std::size_t kCommandSize = 3;
constexpr std::uint8_t kFirstUserFilter = 0xB;

constexpr const Register& kBurst = wire::require_register(Window::w0, 0x00);
constexpr const Register& kCount = wire::require_register(Window::w0, 0x0A);
constexpr const Register& kFirCommand = wire::require_register(Window::w1, 0x16);
constexpr std::uint8_t kTemperatureAddress = 0x0E;
constexpr std::array<std::uint8_t, 3> kAxisAddresses{0x30, 0x34, 0x38};
constexpr std::uint8_t kProductIdAddress = 0x6A;
constexpr std::uint8_t kVersionAddress = 0x72;
constexpr std::uint8_t kSerialAddress = 0x74;

// FLAG bits 15, 11, 10, 9, enabled by the same bits of SIG_CTRL.
constexpr std::uint16_t kNewTemperature = 0x8000;
constexpr std::array<std::uint16_t, 3> kNewAxis{0x0800, 0x0400, 0x0200};

// MSC_CTRL high byte: tests that run, written 1 to start.
constexpr std::uint8_t kSensitivityTests = 0x70;
constexpr std::uint8_t kFlashTest = 0x08;
constexpr std::uint8_t kSelfTests = 0x07;

std::size_t word(std::uint8_t address) { return address / 2U; }

void put32(std::array<std::uint16_t, 64>& bank, std::uint8_t address, std::int32_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    bank[word(address)] = static_cast<std::uint16_t>(bits >> 16U);
    bank[word(address) + 1] = static_cast<std::uint16_t>(bits & 0xFFFFU);
}

std::int32_t get32(const std::array<std::uint16_t, 64>& bank, std::uint8_t address) {
    const std::uint32_t high = bank[word(address)];
    return static_cast<std::int32_t>((high << 16U) | bank[word(address) + 1]);
}

std::optional<int> decoded(std::span<const wire::Coded> table, unsigned code) {
    const auto found = std::ranges::find(table, code, &wire::Coded::code);
    return found == table.end() ? std::nullopt : std::optional(found->value);
}

/// Samples that fill the filter and are not sent: the numbers of table 5.4, all of which are
/// 2^n - 1 with 2^n the next power of two to taps / decimation.
int suppressed_samples(int taps, int decimation) {
    const auto filled = static_cast<unsigned>((taps + decimation - 1) / decimation);
    return static_cast<int>(std::bit_ceil(filled)) - 1;
}

}  // namespace

std::string product_id_of(const wire::DeviceProfile& profile) {
    // The identifier of the A351 is not public; the letters follow the family's naming.
    std::string id(profile.product_id_prefix);
    if (id == "A351") id += "AU10";
    return id;
}

RegisterMachine::RegisterMachine(const wire::DeviceProfile& profile, MachineIdentity identity,
                                 Nanoseconds power_on)
    : profile_(profile), identity_(std::move(identity)), now_(power_on) {
    assert(identity_.product_id.size() == 8 && identity_.serial_number.size() == 8);
    reset(power_on + kPowerOnTime);
}

std::uint16_t& RegisterMachine::at(const Register& reg) {
    return banks_[static_cast<std::size_t>(reg.window)][word(reg.address)];
}

std::uint16_t RegisterMachine::value_of(const Register& reg) const {
    return banks_[static_cast<std::size_t>(reg.window)][word(reg.address)];
}

void RegisterMachine::reset(Nanoseconds ready_at) {
    for (const Register& reg : wire::kRegisters) at(reg) = reg.default_value;
    put_identity();
    window_ = Window::w0;
    partial_.clear();
    ready_at_ = ready_at;
    filter_ready_at_ = tests_end_at_ = now_;
    is_sampling_ = is_aliased_ = false;
    new_data_ = 0;
}

void RegisterMachine::put_identity() {
    put_text(kProductIdAddress, identity_.product_id);
    banks_[1][word(kVersionAddress)] = identity_.firmware;
    put_text(kSerialAddress, identity_.serial_number);
}

/// Two characters a word, the first in the low byte (7.27).
void RegisterMachine::put_text(std::uint8_t first_address, const std::string& text) {
    for (std::size_t i = 0; i < text.size(); i += 2) {
        const auto low = static_cast<unsigned char>(text[i]);
        const auto high = static_cast<unsigned char>(text[i + 1]);
        banks_[1][word(first_address) + i / 2] = static_cast<std::uint16_t>((high << 8) | low);
    }
}

void RegisterMachine::receive(std::span<const std::byte> bytes, Nanoseconds now,
                              std::vector<std::byte>& answers) {
    now_ = now;
    if (!partial_.empty() && now - partial_since_ > kPartialCommandLife) partial_.clear();
    for (const std::byte byte : bytes) {
        if (partial_.empty() && byte == kCarriageReturn) continue;
        if (partial_.empty()) partial_since_ = now;
        partial_.push_back(byte);
        while (partial_.size() == kCommandSize) {
            if (partial_.back() == kCarriageReturn) {
                const auto address = std::to_integer<std::uint8_t>(partial_[0]);
                const auto value = std::to_integer<std::uint8_t>(partial_[1]);
                partial_.clear();
                execute(address, value, answers);
            } else {
                partial_.erase(partial_.begin());
                if (partial_.front() == kCarriageReturn) partial_.erase(partial_.begin());
            }
        }
    }
}

void RegisterMachine::execute(std::uint8_t address, std::uint8_t value,
                              std::vector<std::byte>& answers) {
    ++command_count_;
    if ((address & kWriteBit) == 0) {
        read(address, answers);
    } else {
        write(address & static_cast<std::uint8_t>(~kWriteBit), value, answers);
    }
}

void RegisterMachine::update_busy_bits() {
    const auto set = [](std::uint16_t& reg, std::uint16_t bits, bool is_set) {
        reg = static_cast<std::uint16_t>(is_set ? reg | bits : reg & ~bits);
    };
    set(at(wire::kGlobCmd), wire::kGlobNotReady, now_ < ready_at_);
    set(at(wire::kFilterCtrl), wire::kFilterBusy, now_ < filter_ready_at_);
    if (now_ >= tests_end_at_) set(at(wire::kMscCtrl), wire::kHighByte, false);
}

/// While the device starts up only GLOB_CMD answers.
void RegisterMachine::read(std::uint8_t address, std::vector<std::byte>& answers) {
    update_busy_bits();
    const Register* reg = wire::register_at(window_, address & 0xFE);
    if (now_ < ready_at_ && reg != &wire::kGlobCmd) return;
    std::uint16_t value = reg == nullptr ? std::uint16_t{0} : value_of(*reg);
    if (reg == &wire::kFlag) value = flag();
    answers.push_back(std::byte{address});
    answers.push_back(static_cast<std::byte>(value >> 8));
    answers.push_back(static_cast<std::byte>(value & 0xFF));
    answers.push_back(kCarriageReturn);

    if (reg == &wire::kDiagStat) at(*reg) = 0;
    if (window_ != Window::w0) return;
    const auto clear = [this](std::uint16_t bit) {
        new_data_ = static_cast<std::uint16_t>(new_data_ & ~bit);
    };
    if (word(address) - word(kTemperatureAddress) < 2) clear(kNewTemperature);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (word(address) - word(kAxisAddresses[axis]) < 2) clear(kNewAxis[axis]);
    }
}

void RegisterMachine::write(std::uint8_t address, std::uint8_t value,
                            std::vector<std::byte>& frames) {
    const Register* reg = wire::register_at(window_, address & 0xFE);
    if (reg == nullptr) return;
    const bool is_high_byte = (address & 1U) != 0;
    if ((reg->writable_bytes & (is_high_byte ? wire::kHighByte : wire::kLowByte)) == 0) return;
    if (reg->name == wire::kWinCtrl.name) {
        if (value > 1) return;
        window_ = static_cast<Window>(value);
        banks_[0][word(reg->address)] = banks_[1][word(reg->address)] = value;
        return;
    }
    if (now_ < ready_at_) return;
    if (reg == &wire::kModeCtrl) return write_mode(value);
    if (reg == &wire::kGlobCmd) {
        if ((value & wire::kGlobSoftReset) != 0) reset(now_ + kResetTime);
        return;
    }
    if (reg == &kBurst) {
        const auto layout = wire::BurstLayout::from_burst_ctrl(value_of(wire::kBurstCtrl));
        const bool is_manual = (value_of(wire::kUartCtrl) & wire::kUartAuto) == 0;
        if (value == 0 && is_sampling_ && is_manual && layout) {
            wire::append_frame(*layout, take_values(), frames);
        }
        return;
    }
    if (!is_sampling_) write_register(*reg, is_high_byte, value);
}

void RegisterMachine::write_mode(std::uint8_t value) {
    const auto command = static_cast<std::uint16_t>((value & 0x03U) << 8U);
    if (command == wire::kModeCmdSampling && !is_sampling_) start_sampling();
    if (command == wire::kModeCmdConfig) fall_back_to_configuration();
}

void RegisterMachine::start_sampling() {
    is_sampling_ = true;
    ++sampling_run_;
    at(wire::kModeCtrl) = 0;
    at(kCount) = 0;
    new_data_ = 0;
    transient_left_ = suppressed_samples(filter().taps, profile_.count_step(output_rate_hz()));
}

/// A value that the data sheet reserves is not taken.
void RegisterMachine::write_register(const Register& reg, bool is_high_byte, std::uint8_t value) {
    const unsigned byte = is_high_byte ? static_cast<unsigned>(value) << 8U : value;
    const unsigned mask = is_high_byte ? wire::kHighByte : wire::kLowByte;
    const auto next =
        static_cast<std::uint16_t>((value_of(reg) & ~mask) | (byte & mask & reg.defined_bits));
    if (&reg == &kFirCommand) return;
    if (&reg == &wire::kMscCtrl && is_high_byte) return start_tests(value & 0x7FU);
    if (&reg == &wire::kSmplCtrl && !decoded(profile_.output_rates_hz, next >> 8U)) {
        return;
    }
    if (&reg == &wire::kUartCtrl && !decoded(profile_.baud_rates, next >> 8U)) return;
    if (&reg == &wire::kFilterCtrl) {
        const auto code = static_cast<std::uint8_t>(next & wire::kFilterSelect);
        if (profile_.filter_coded(code) == nullptr) return;
        at(reg) = code;
        filter_ready_at_ = now_ + (code < kFirstUserFilter ? kFilterTime : kUserFilterTime);
    } else {
        at(reg) = next;
    }
    if (&reg == &wire::kSmplCtrl || &reg == &wire::kFilterCtrl) check_aliasing();
}

/// Every test passes: the emulated device is healthy.
void RegisterMachine::start_tests(std::uint8_t high_byte) {
    std::uint16_t& control = at(wire::kMscCtrl);
    control = static_cast<std::uint16_t>((control & wire::kLowByte) | (high_byte << 8U));
    if ((high_byte & kSensitivityTests) != 0) {
        tests_end_at_ = now_ + kSensitivityTestTime;
    } else if ((high_byte & kSelfTests) != 0) {
        tests_end_at_ = now_ + kSelfTestTime;
    } else if ((high_byte & kFlashTest) != 0) {
        tests_end_at_ = now_ + kFlashTestTime;
    }
}

void RegisterMachine::check_aliasing() {
    const auto rates = filter().allowed_rates_hz;
    is_aliased_ = std::find(rates.begin(), rates.end(), output_rate_hz()) == rates.end();
}

const wire::FilterSpec& RegisterMachine::filter() const {
    const std::uint16_t code = value_of(wire::kFilterCtrl) & wire::kFilterSelect;
    return *profile_.filter_coded(static_cast<std::uint8_t>(code));
}

int RegisterMachine::output_rate_hz() const noexcept {
    return *decoded(profile_.output_rates_hz, value_of(wire::kSmplCtrl) >> 8U);
}

Nanoseconds RegisterMachine::frame_delay() const {
    constexpr std::int64_t kBitsPerByte = 10;
    const auto layout = wire::BurstLayout::from_burst_ctrl(value_of(wire::kBurstCtrl));
    const std::int64_t bytes = layout ? static_cast<std::int64_t>(layout->frame_size()) : 0;
    return profile_.group_delay(filter()) + profile_.data_ready_delay +
           Nanoseconds(bytes * kBitsPerByte * 1'000'000'000 / baud());
}

int RegisterMachine::baud() const noexcept {
    return *decoded(profile_.baud_rates, value_of(wire::kUartCtrl) >> 8U);
}

void RegisterMachine::skip_sample() {
    if (!is_sampling_) return;
    if (transient_left_ > 0) {
        --transient_left_;
    } else {
        advance_counter(profile_.count_step(output_rate_hz()));
    }
}

void RegisterMachine::advance_counter(unsigned ticks) {
    at(kCount) = static_cast<std::uint16_t>((value_of(kCount) + ticks) & 0xFFFFU);
}

void RegisterMachine::power_cycle(Nanoseconds now) {
    now_ = now;
    reset(now + kPowerOnTime);
}

void RegisterMachine::spontaneous_reset(Nanoseconds now) {
    now_ = now;
    reset(now + kResetTime);
}

void RegisterMachine::fall_back_to_configuration() {
    is_sampling_ = false;
    at(wire::kModeCtrl) = wire::kModeStatConfig;
}

void RegisterMachine::raise_diagnostics(std::uint16_t diag_stat_bits) {
    at(wire::kDiagStat) = static_cast<std::uint16_t>(value_of(wire::kDiagStat) | diag_stat_bits);
}

void RegisterMachine::jump_counter(std::uint16_t ticks) { advance_counter(ticks); }

void RegisterMachine::rename(MachineIdentity identity) {
    identity_ = std::move(identity);
    put_identity();
}

std::uint16_t RegisterMachine::flag() const {
    unsigned flag = new_data_;
    if (is_aliased_) flag |= wire::kFlagAliasing;
    if (value_of(wire::kDiagStat) != 0) flag |= wire::kFlagError;
    return static_cast<std::uint16_t>(flag);
}

void RegisterMachine::store(const SensorSample& sample) {
    put32(banks_[0], kTemperatureAddress, sample.temperature_counts);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        put32(banks_[0], kAxisAddresses[axis],
              is_aliased_ ? kAliasedCounts : sample.axes_counts[axis]);
    }
    advance_counter(profile_.count_step(output_rate_hz()));
    new_data_ = value_of(wire::kSigCtrl) & wire::kSigNewDataEnables;
}

/// The frame of the sample in the registers; sending it is reading it.
wire::BurstValues RegisterMachine::take_values() {
    wire::BurstValues values;
    values.flag = flag();
    values.temperature = get32(banks_[0], kTemperatureAddress);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        values.axes[axis] = get32(banks_[0], kAxisAddresses[axis]);
    }
    values.count = value_of(kCount);
    new_data_ = 0;
    return values;
}

std::optional<wire::BurstValues> RegisterMachine::sample(const SensorSample& sample,
                                                         std::vector<std::byte>& frames) {
    if (!is_sampling_) return std::nullopt;
    if (transient_left_ > 0) {
        --transient_left_;
        return std::nullopt;
    }
    store(sample);
    const auto layout = wire::BurstLayout::from_burst_ctrl(value_of(wire::kBurstCtrl));
    if ((value_of(wire::kUartCtrl) & wire::kUartAuto) == 0 || !layout) return std::nullopt;
    const wire::BurstValues values = take_values();
    wire::append_frame(*layout, values, frames);
    return values;
}

}  // namespace a351::sim
