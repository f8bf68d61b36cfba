#pragma once
/// @file
/// Commands to the sensor as bytes, and its answers; no I/O.  In sampling mode the device ignores
/// writes and mixes answers into the frame stream, so a program holds either a ConfigMode, which
/// has commands, or a SamplingMode, which can only stop.
/// M-A352AD10 data sheet, 5.2, 6.2.1-6.2.3 (framing), 7.2 (modes).

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "protocol/wire/registers.hpp"

namespace a351::wire {

/// Address, value, CR.
using Command = std::array<std::byte, 3>;

/// Commands to be sent one by one, kCommandSpacing apart.  Each sequence starts by selecting its
/// window: `83 01` starts sampling in window 0 but a self test in window 1.
using CommandSequence = std::vector<Command>;

/// Time from the start of one command to the start of the next.  The device needs 0.66 ms at 115200
/// baud, less at higher rates (table 6.9).
inline constexpr std::chrono::milliseconds kCommandSpacing{1};

/// Returns the commands that switch to configuration mode.  They are valid in any mode and window;
/// the device does not answer them and falls silent.
[[nodiscard]] CommandSequence stop_sampling();

/// Returns the commands that read MODE_CTRL, the only useful register before the mode is known.
[[nodiscard]] CommandSequence read_mode();

inline constexpr std::size_t kAnswerSize = 4;  ///< Address, high byte, low byte, CR.

/// Returns the value in the answer to a read of `reg`.  The answer is recognised by its length,
/// because CR may be part of the value.
/// @return std::nullopt unless it is four bytes, the first the address of `reg`, the last CR.
[[nodiscard]] std::optional<std::uint16_t> parse_answer(const Register& reg,
                                                        std::span<const std::byte> answer) noexcept;

/// State of a device that is sampling: no register may be read or written.
class SamplingMode {
public:
    /// Returns the commands that stop sampling.  The device is in configuration mode again when
    /// MODE_CTRL says so.
    [[nodiscard]] CommandSequence stop() &&;

private:
    friend class ConfigMode;
    SamplingMode() = default;
};

/// State of a device that has reported configuration mode.
class ConfigMode {
public:
    /// Returns the state if MODE_CTRL reports configuration mode, else std::nullopt.
    /// @param mode_ctrl  as read from the device.
    [[nodiscard]] static std::optional<ConfigMode> from_mode_ctrl(std::uint16_t mode_ctrl) noexcept;

    [[nodiscard]] CommandSequence read(const Register& reg) const;

    /// Returns the commands that write those bytes of `reg` that hold a bit of `mask`; reserved
    /// bits are written as 0.  The device does not acknowledge a write: read the register back.
    /// Precondition: the device permits writing these bytes.
    [[nodiscard]] CommandSequence write(const Register& reg, std::uint16_t value,
                                        std::uint16_t mask) const;

    [[nodiscard]] std::pair<SamplingMode, CommandSequence> start_sampling() &&;

private:
    ConfigMode() = default;
};

}  // namespace a351::wire
