#include "protocol/wire/commands.hpp"

#include <cassert>

#include "protocol/wire/burst_frame.hpp"

namespace a351::wire {
namespace {

constexpr std::uint8_t kWriteBit = 0x80;

Command make_command(unsigned first, unsigned second) {
    return {static_cast<std::byte>(first), static_cast<std::byte>(second & 0xFFU), kEndByte};
}

Command select(Window window) {
    return make_command(kWriteBit | kWinCtrl.address, static_cast<unsigned>(window));
}

CommandSequence read_commands(const Register& reg) {
    return {select(reg.window), make_command(reg.address, 0)};
}

CommandSequence write_commands(const Register& reg, std::uint16_t value, std::uint16_t mask) {
    CommandSequence commands{select(reg.window)};
    const unsigned bits = value & reg.defined_bits;
    if ((mask & kHighByte) != 0) {
        assert((reg.writable_bytes & kHighByte) != 0);
        commands.push_back(make_command(kWriteBit | (reg.address + 1U), bits >> 8U));
    }
    if ((mask & kLowByte) != 0) {
        assert((reg.writable_bytes & kLowByte) != 0);
        commands.push_back(make_command(kWriteBit | reg.address, bits));
    }
    return commands;
}

}  // namespace

CommandSequence stop_sampling() { return write_commands(kModeCtrl, kModeCmdConfig, kHighByte); }

CommandSequence read_mode() { return read_commands(kModeCtrl); }

std::optional<std::uint16_t> parse_answer(const Register& reg,
                                          std::span<const std::byte> answer) noexcept {
    if (answer.size() != kAnswerSize || answer[0] != std::byte{reg.address} ||
        answer[3] != kEndByte) {
        return std::nullopt;
    }
    return word_at(answer, 1);
}

CommandSequence SamplingMode::stop() && { return stop_sampling(); }

std::optional<ConfigMode> ConfigMode::from_mode_ctrl(std::uint16_t mode_ctrl) noexcept {
    if ((mode_ctrl & kModeStat) != kModeStatConfig) return std::nullopt;
    return ConfigMode();
}

CommandSequence ConfigMode::read(const Register& reg) const { return read_commands(reg); }

CommandSequence ConfigMode::write(const Register& reg, std::uint16_t value,
                                  std::uint16_t mask) const {
    return write_commands(reg, value, mask);
}

std::pair<SamplingMode, CommandSequence> ConfigMode::start_sampling() && {
    return {SamplingMode(), write_commands(kModeCtrl, kModeCmdSampling, kHighByte)};
}

}  // namespace a351::wire
