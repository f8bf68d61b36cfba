#pragma once
/// @file
/// Commands to the sensor as bytes, and its answers; no I/O.  In sampling mode the device ignores
/// writes and mixes answers into the frame stream, so a program holds either a ConfigMode, which
/// has commands, or a SamplingMode, which can only stop.  While sampling, the device obeys only
/// writes that change the mode, reset it or select a window.
/// M-A352AD10 data sheet, 5.2, 6.2.1-6.2.3 (framing), 7.2 (modes).
///
/// Use Handshake (handshake.hpp) to bring a sensor into sampling: it makes these commands in the
/// right order and checks each step.  Use this header to stop a sensor, or for single registers:
///
///     send(stop_sampling());  // Then discard input until the line is silent.
///     send(read_mode());
///     const auto mode = parse_answer(kModeCtrl, receive(kAnswerSize));
///     auto config = mode ? ConfigMode::from_mode_ctrl(*mode) : std::nullopt;
///     if (!config) return;    // No answer, or not in configuration mode.
///     send(config->read(kFilterCtrl));
///     const auto filter = parse_answer(kFilterCtrl, receive(kAnswerSize));
///     auto [sampling, start] = std::move(*config).start_sampling();
///     send(start);            // Frames follow.
///     send(std::move(sampling).stop());
///
/// `send` and `receive` are the caller's.  All functions depend on their arguments only and may be
/// called from any thread.  commands_test.cpp compares the bytes with the data sheet, 8.2.3.

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

/// Address, value, CR.  Bit 7 of the address is set in a write, which sets one byte of a register.
/// It is clear in a read, which returns both bytes; the value of a read has no meaning and is 0.
using Command = std::array<std::byte, 3>;

/// Commands to be sent one by one, kCommandSpacing apart.  Each sequence starts by selecting its
/// window: `83 01` starts sampling in window 0 but a self test in window 1.
///
/// Do not pass several commands to one write(): at 460800 baud they would start 65 us apart, and
/// the device needs 200 us.
using CommandSequence = std::vector<Command>;

/// Time from the start of one command to the start of the next.  The device needs 0.66 ms at 115200
/// baud, less at higher rates (table 6.9).
inline constexpr std::chrono::milliseconds kCommandSpacing{1};

/// Returns the commands that switch to configuration mode.  They are valid in any window and in
/// every mode but sleep, in which the device receives nothing; the device does not answer them and
/// falls silent.
///
/// Frames sent before are still on their way: discard input until the line is silent.  Then send
/// read_mode(), because a lost command leaves no other trace.
[[nodiscard]] CommandSequence stop_sampling();

/// Returns the commands that read MODE_CTRL, the only useful register before the mode is known.
/// Give the answer to parse_answer() with kModeCtrl, and its value to ConfigMode::from_mode_ctrl().
[[nodiscard]] CommandSequence read_mode();

inline constexpr std::size_t kAnswerSize = 4;  ///< Address, high byte, low byte, CR.

/// Returns the value in the answer to a read of `reg`.  The answer is recognised by its length,
/// because CR may be part of the value.
///
/// The value is complete, with reserved bits as the device sent them; mask it with
/// Register::defined_bits before a comparison.  An answer does not name its window: the register at
/// the same address of the other window gives an answer that is accepted too.
///
/// @param reg     register that was read.
/// @param answer  all bytes received since the read; more than kAnswerSize are refused too.
/// @return std::nullopt unless it is four bytes, the first the address of `reg`, the last CR.
[[nodiscard]] std::optional<std::uint16_t> parse_answer(const Register& reg,
                                                        std::span<const std::byte> answer) noexcept;

/// State of a device that is sampling: no register may be read or written.  It is made by
/// ConfigMode::start_sampling() only; `tests/compile_fail` shows that it has no other commands.
class SamplingMode {
public:
    /// Returns the commands that stop sampling.  The device is in configuration mode again when
    /// MODE_CTRL says so.  They are those of stop_sampling(); this object must not be used again.
    [[nodiscard]] CommandSequence stop() &&;

private:
    friend class ConfigMode;
    SamplingMode() = default;
};

/// State of a device that has reported configuration mode.
///
/// An object can be copied, and it does not know what the device does later.  Discard it and all
/// copies when the device is reset, loses its power or no longer answers.
class ConfigMode {
public:
    /// Returns the state if MODE_CTRL reports configuration mode, else std::nullopt.
    /// Only MODE_STAT (bits 11:10) is compared.
    /// @param mode_ctrl  as read from the device.
    [[nodiscard]] static std::optional<ConfigMode> from_mode_ctrl(std::uint16_t mode_ctrl) noexcept;

    /// Returns the commands that select the window of `reg` and read it.  The device answers with
    /// kAnswerSize bytes; give them to parse_answer() with the same register.  Reading DIAG_STAT
    /// clears it, and reading FLAG clears its alarm bits.
    [[nodiscard]] CommandSequence read(const Register& reg) const;

    /// Returns the commands that write those bytes of `reg` that hold a bit of `mask`; reserved
    /// bits are written as 0.  The device does not acknowledge a write: read the register back.
    /// Precondition: the device permits writing these bytes.
    ///
    /// A byte is always written as a whole: bits of it outside `mask` take their value from `value`
    /// too.  To keep them, read the register first and pass `(old & ~mask) | wanted`.  The high
    /// byte is written before the low byte.
    ///
    /// @param value  new content of the register; its bytes without a bit of `mask` are not used.
    /// @param mask   bits to change; with 0 only the window is selected.
    [[nodiscard]] CommandSequence write(const Register& reg, std::uint16_t value,
                                        std::uint16_t mask) const;

    /// Returns the new state, and the commands that start sampling.  With UART_AUTO set, the device
    /// sends a frame for each sample after its filter is filled.  This object must not be used
    /// again.  There is no answer: the first frame shows that the commands were received.
    [[nodiscard]] std::pair<SamplingMode, CommandSequence> start_sampling() &&;

private:
    ConfigMode() = default;
};

}  // namespace a351::wire
