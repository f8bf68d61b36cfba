#include "sim/device/register_file.hpp"

#include <algorithm>

#include "sim/device/signal_path.hpp"

namespace a351::sim::device {
namespace {

std::size_t bank_of(const wire::Register& reg) { return static_cast<std::size_t>(reg.window); }
std::size_t word_of(const wire::Register& reg) { return reg.address / 2U; }

constexpr unsigned kMostLongFilterTapsCode = 12;  // 2^12 taps (7.20).
constexpr unsigned kFirstFirAddress = 0x08;       // High byte of 0x0800 ... 0x0FFF (7.18).

}  // namespace

std::optional<int> decoded(std::span<const wire::Coded> table, unsigned code) {
    const auto found = std::ranges::find(table, code, &wire::Coded::code);
    return found == table.end() ? std::nullopt : std::optional(found->value);
}

bool may_hold(const wire::DeviceProfile& profile, const wire::Register& reg, std::uint16_t value) {
    const unsigned high = value >> 8U;
    if (&reg == &wire::kSmplCtrl) return decoded(profile.output_rates_hz, high).has_value();
    if (&reg == &wire::kUartCtrl) return decoded(profile.baud_rates, high).has_value();
    if (&reg == &wire::kMscCtrl) return high == 0;  // A write starts tests and is not stored.
    if (&reg == &wire::kFilterCtrl) {
        if ((value & wire::kFilterBusy) != 0) return false;
        return profile.filter_coded(static_cast<std::uint8_t>(value & wire::kFilterSelect)) !=
               nullptr;
    }
    if (&reg == &kLongFilterTaps) return value >= 1 && value <= kMostLongFilterTapsCode;
    if (&reg == &kFirAddress) return high >= kFirstFirAddress;
    return true;
}

bool has_factory_codes(const wire::DeviceProfile& profile) {
    return may_hold(profile, wire::kSmplCtrl, wire::kSmplCtrl.default_value) &&
           may_hold(profile, wire::kFilterCtrl, wire::kFilterCtrl.default_value) &&
           may_hold(profile, wire::kUartCtrl, wire::kUartCtrl.default_value);
}

RegisterFile::RegisterFile() {
    for (const wire::Register& reg : wire::kRegisters) at(reg) = reg.default_value;
}

std::uint16_t& RegisterFile::at(const wire::Register& reg) {
    return banks_[bank_of(reg)][word_of(reg)];
}

std::uint16_t RegisterFile::at(const wire::Register& reg, std::size_t further) const {
    return banks_[bank_of(reg)][word_of(reg) + further];
}

std::int32_t RegisterFile::get32(const wire::Register& first, std::size_t axis) const {
    const std::size_t word = word_of(first) + 2 * axis;
    const std::uint32_t high = banks_[bank_of(first)][word];
    return static_cast<std::int32_t>((high << 16U) | banks_[bank_of(first)][word + 1]);
}

void RegisterFile::put32(const wire::Register& first, std::int32_t value, std::size_t axis) {
    const std::size_t word = word_of(first) + 2 * axis;
    const auto bits = static_cast<std::uint32_t>(value);
    banks_[bank_of(first)][word] = static_cast<std::uint16_t>(bits >> 16U);
    banks_[bank_of(first)][word + 1] = static_cast<std::uint16_t>(bits & 0xFFFFU);
}

void RegisterFile::put_text(const wire::Register& first, std::string_view text) {
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        const auto low = static_cast<unsigned char>(text[i]);
        const auto high = static_cast<unsigned char>(text[i + 1]);
        banks_[bank_of(first)][word_of(first) + i / 2] =
            static_cast<std::uint16_t>((high << 8) | low);
    }
}

bool has_rate_for_long_filter(const wire::DeviceProfile& profile, const RegisterFile& registers) {
    if ((registers.at(kLongFilter) & kLongFilterOn) == 0) return true;
    return *decoded(profile.output_rates_hz, registers.at(wire::kSmplCtrl) >> 8U) <=
           LongTermFilter::kHighestRateHz;
}

}  // namespace a351::sim::device
