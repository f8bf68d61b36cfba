#pragma once
/// @file
/// Parser of the host's commands.  M-A352AD10 data sheet, rev. 20251023, 6.2.1-6.2.3.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::sim {

struct HostCommand {
    std::uint8_t address = 0;  ///< Bit 7: a write.
    std::uint8_t value = 0;
};

/// Every command is address, value, CR.  The data sheet does not define damaged commands.  The
/// rules here let a lone CR, as hosts send it, end a partial command:
/// - A CR at the start of a command is skipped.
/// - If the third byte is not CR, the first byte is dropped and the rest is parsed again.
/// - A partial command is forgotten after kPartialCommandLife.
class CommandParser {
public:
    static constexpr std::chrono::milliseconds kPartialCommandLife{100};  ///< Assumed.

    /// Takes a byte.  @return the command that `byte` completes, if any.
    [[nodiscard]] std::optional<HostCommand> next(std::byte byte, Nanoseconds now);

    void forget() { partial_.clear(); }

private:
    std::vector<std::byte> partial_;
    Nanoseconds since_{0};  ///< Arrival of its first byte.
};

}  // namespace a351::sim
