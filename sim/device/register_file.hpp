#pragma once
/// @file
/// The registers of the emulated sensor as memory, and the values that they may hold.
/// M-A352AD10 data sheet, rev. 20251023, table 7.1 and sections 7.11-7.20.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/registers.hpp"

namespace a351::sim::device {

inline constexpr const wire::Register& kBurst = wire::require_register(wire::Window::w0, 0x00);
inline constexpr const wire::Register& kCount = wire::require_register(wire::Window::w0, 0x0A);
inline constexpr const wire::Register& kTemperature =
    wire::require_register(wire::Window::w0, 0x0E);
inline constexpr const wire::Register& kAcceleration =
    wire::require_register(wire::Window::w0, 0x30);  ///< X; Y and Z follow, four bytes apart.
inline constexpr const wire::Register& kTilt = wire::require_register(wire::Window::w0, 0x3C);
inline constexpr const wire::Register& kFirCommand = wire::require_register(wire::Window::w1, 0x16);
inline constexpr const wire::Register& kFirData = wire::require_register(wire::Window::w1, 0x18);
inline constexpr const wire::Register& kFirAddress = wire::require_register(wire::Window::w1, 0x1A);
inline constexpr const wire::Register& kLongFilter = wire::require_register(wire::Window::w1, 0x1C);
inline constexpr const wire::Register& kLongFilterTaps =
    wire::require_register(wire::Window::w1, 0x1E);
inline constexpr const wire::Register& kOffset = wire::require_register(wire::Window::w1, 0x2C);
inline constexpr const wire::Register& kAlarm = wire::require_register(wire::Window::w1, 0x46);
inline constexpr const wire::Register& kProductId = wire::require_register(wire::Window::w1, 0x6A);
inline constexpr const wire::Register& kVersion = wire::require_register(wire::Window::w1, 0x72);
inline constexpr const wire::Register& kSerial = wire::require_register(wire::Window::w1, 0x74);

inline constexpr std::uint16_t kLongFilterOn = 0x0001;  ///< LONGFILT_CTRL: FILT_EN (7.19).

/// Returns the value of a configuration field with this code; std::nullopt for an unknown code.
[[nodiscard]] std::optional<int> decoded(std::span<const wire::Coded> table, unsigned code);

/// Returns true if the register may hold the value: the data sheet neither reserves it nor leaves
/// it unused, and it does not only report a state.
[[nodiscard]] bool may_hold(const wire::DeviceProfile& profile, const wire::Register& reg,
                            std::uint16_t value);

/// Returns true if the profile has the codes of rate, filter and baud of a device with factory flash.
/// The emulated device starts with them.
[[nodiscard]] bool has_factory_codes(const wire::DeviceProfile& profile);

class RegisterFile {
public:
    RegisterFile();  ///< Starts with the factory values.

    /// Return a register.  @param further  number of registers after it.
    [[nodiscard]] std::uint16_t& at(const wire::Register& reg);
    [[nodiscard]] std::uint16_t at(const wire::Register& reg, std::size_t further = 0) const;

    /// Read or write axis 0 ... 2 of a 32-bit quantity; `first` is the high word of axis 0.
    [[nodiscard]] std::int32_t get32(const wire::Register& first, std::size_t axis = 0) const;
    void put32(const wire::Register& first, std::int32_t value, std::size_t axis = 0);

    /// Writes two characters per register, the first in the low byte (7.27).
    void put_text(const wire::Register& first, std::string_view text);

private:
    using Bank = std::array<std::uint16_t, 64>;
    std::array<Bank, 2> banks_{};
};

/// Returns true if the long-term filter is off or works at the rate of SMPL_CTRL (5.17.4).
[[nodiscard]] bool has_rate_for_long_filter(const wire::DeviceProfile& profile,
                                            const RegisterFile& registers);

}  // namespace a351::sim::device
