#pragma once
/// @file
/// Everything that a sensor was asked and sent, before anything is concluded from it.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/wire/handshake.hpp"

namespace a351::daemon::identify {

struct Observation {
    std::string port;   ///< Description of the port; empty if it could not be opened.
    std::string heard;  ///< First bytes received before any command, at most kMostHeard.
    int baud = 0;       ///< Rate at which the sensor answered, or the last one that was tried.
    /// Reason why there are no frames; empty if sampling was started.
    std::string trouble;
    bool has_answered = false;  ///< True if a question got a valid answer.
    wire::DeviceIdentity device;
    /// Result of the test that the reset of this question made.
    wire::StartUpTest start_up_test = wire::StartUpTest::unknown;
    std::vector<wire::RegisterValue> registers;  ///< Read before a setting was written.
    int repeated_reads = 0;        ///< Number of reads of any register that were repeated.
    std::vector<std::byte> bytes;  ///< Received while sampling.
    std::vector<journal::ReadStamp> reads;  ///< Arrivals of `bytes`.
    UtcTime time;                           ///< Time of the end.
};

inline constexpr std::size_t kMostHeard = 4096;

/// Returns true if bytes are lines of text, as of a GPS receiver: 16 or more, all of them printable
/// ASCII or ends of lines.  In frames every 24 bytes have a start byte, which is not ASCII.
[[nodiscard]] bool is_text(const std::string& bytes) noexcept;

}  // namespace a351::daemon::identify
