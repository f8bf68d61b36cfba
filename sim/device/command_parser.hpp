#pragma once
/// @file
/// Bytes from the host -> commands.  M-A352AD10 data sheet, rev. 20251023, 6.2.1-6.2.3.

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

/// Every command is address, value, CR.  What the data sheet leaves open is decided so that a lone
/// CR, as hosts send it, ends whatever was half received: a CR at a command's start is skipped;
/// if the third byte is no CR, the first is dropped and the rest looked at again; a partial command
/// is forgotten after kPartialCommandLife.
class CommandParser {
public:
    static constexpr std::chrono::milliseconds kPartialCommandLife{100};  ///< Assumed.

    /// @return the command that `byte` completes.
    [[nodiscard]] std::optional<HostCommand> next(std::byte byte, Nanoseconds now);

    void forget() { partial_.clear(); }

private:
    std::vector<std::byte> partial_;
    Nanoseconds since_{0};  ///< Its first byte arrived.
};

}  // namespace a351::sim
