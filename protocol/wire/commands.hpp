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

/// Sent one by one, kCommandSpacing apart.  Each sequence starts by selecting its window: `83 01`
/// starts sampling in window 0 but a self test in window 1.
using CommandSequence = std::vector<Command>;

/// Start of one command to start of the next: 0.66 ms at 115200 baud, less above (table 6.9).
inline constexpr std::chrono::milliseconds kCommandSpacing{1};

/// Commands to go to configuration mode, right in any mode and window; the answer is silence.
[[nodiscard]] CommandSequence stop_sampling();

/// Commands to ask for MODE_CTRL, the one register worth reading before the mode is known.
[[nodiscard]] CommandSequence read_mode();

inline constexpr std::size_t kAnswerSize = 4;  ///< Address, high byte, low byte, CR.

/// The value in the answer to a read of `reg`.  Taken by length, for CR may be part of the value.
/// @return std::nullopt unless it is four bytes, the first the address asked, the last CR.
[[nodiscard]] std::optional<std::uint16_t> parse_answer(const Register& reg,
                                                        std::span<const std::byte> answer) noexcept;

/// The device is sampling: nothing may be asked or written.
class SamplingMode {
public:
    /// The device is in configuration mode again once MODE_CTRL says so.
    [[nodiscard]] CommandSequence stop() &&;

private:
    friend class ConfigMode;
    SamplingMode() = default;
};

/// The device has said that it is in configuration mode.
class ConfigMode {
public:
    /// @param mode_ctrl  as read from the device.
    [[nodiscard]] static std::optional<ConfigMode> from_mode_ctrl(std::uint16_t mode_ctrl) noexcept;

    [[nodiscard]] CommandSequence read(const Register& reg) const;

    /// Writes those bytes of `reg` that hold a bit of `mask`, reserved bits as 0.  Never
    /// acknowledged: read back.  A byte that the device does not let write is a broken promise.
    [[nodiscard]] CommandSequence write(const Register& reg, std::uint16_t value,
                                        std::uint16_t mask) const;

    [[nodiscard]] std::pair<SamplingMode, CommandSequence> start_sampling() &&;

private:
    ConfigMode() = default;
};

}  // namespace a351::wire
