#pragma once
/// @file
/// Content of the journal: the raw received bytes with their arrival times, and everything needed
/// to interpret them later.  Bytes on disk: protocol/journal/journal-format.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/timing/clock_reading.hpp"
#include "protocol/timing/sample_clock.hpp"

namespace a351::record {

/// Random identifier of one run of sampling in which the counter is continuous.
struct SessionId {
    std::array<std::uint8_t, 16> bytes{};

    [[nodiscard]] std::string to_hex() const;
    [[nodiscard]] static std::optional<SessionId> from_hex(std::string_view text);
    auto operator<=>(const SessionId&) const = default;
};

/// SEED codes of a sensor, and the channel suffix of each axis.
struct StationCodes {
    std::string network = "XX";                      ///< 1-2 characters A-Z 0-9.
    std::string station = "A351";                    ///< 1-5 characters A-Z 0-9.
    std::string location = "00";                     ///< 2 characters, or empty.
    std::array<std::string, 3> axes{"1", "2", "Z"};  ///< Last letter of x, y, z; A-Z 0-9.

    bool operator==(const StationCodes&) const = default;
};

/// Returns true if each code has the permitted characters and length.  Codes name directories, so
/// codes read from a file must be checked.
[[nodiscard]] bool are_valid(const StationCodes& codes) noexcept;

/// Chunks of an earlier segment, from chunk `sequence` on.
struct RepeatedChunks {
    std::uint64_t segment = 0;
    std::uint32_t sequence = 0;

    bool operator==(const RepeatedChunks&) const = default;
};

/// Limits of the sample interval of the oven's channels in the archive.
inline constexpr std::chrono::seconds kShortestOvenInterval{1}, kLongestOvenInterval{3600};

/// Header of every segment, so that a reader needs only the file.
struct JournalHeader {
    SessionId session;
    std::string boot_id;  ///< Boot of the kernel, which defines the zero of the raw clock.
    std::string program_version;
    StationCodes codes;
    std::string profile;  ///< Name of the wire::DeviceProfile.
    std::string product_id;
    std::string serial_number;
    std::uint16_t firmware = 0;
    /// True if the device was already sampling and was not queried: product, serial number and
    /// firmware are those of the session before.
    bool is_device_assumed = false;
    std::string port;  ///< Configured path or USB identity; empty if there is none.
    int output_rate_hz = 0;
    std::string filter;
    std::uint16_t burst_ctrl = 0;
    int baud = 0;
    std::optional<double> declared_rate_hz;  ///< Rate of blockette 100; absent until commissioned.
    std::chrono::seconds oven_interval{1};   ///< Sample interval of the oven's channels.
    timing::ClockReading clock;
    /// Earlier chunks that the first chunks of this segment repeat, because their sync failed.
    std::optional<RepeatedChunks> repeats;
};

/// Returns true if a stream with header `next` is read in the same way as one with `last`, by the
/// same host clock.  Only then can it continue the session.
[[nodiscard]] bool is_same_stream(const JournalHeader& last, const JournalHeader& next);

// Limits of the values in a journal.  Raw time has the limits of UTC, because it counts like UTC on
// simulated time.  Within these limits an instant plus a difference of two others is below 2^63 ns.
inline constexpr Nanoseconds kEarliestInstant{-(std::int64_t{1} << 58U)};   ///< Year 1960.
inline constexpr Nanoseconds kLatestInstant{3'900'000'000'000'000'000};     ///< Year 2093.
inline constexpr Nanoseconds kLongestSpan{std::int64_t{1} << 58U};          ///< 9 years.
inline constexpr std::int64_t kMostClockError_us = std::int64_t{1} << 47U;  ///< 4 years.
inline constexpr std::int64_t kLargestIndex = std::int64_t{1} << 53U;

/// Returns true if all times and errors are within these limits.
[[nodiscard]] bool is_in_range(const timing::ClockReading& clock) noexcept;

/// One read() of the port.
struct ReadStamp {
    std::uint32_t end = 0;  ///< End of its bytes within the chunk.
    RawTime time;           ///< Taken right after read() returned.

    bool operator==(const ReadStamp&) const = default;
};

/// Largest payload of a chunk, bytes: keeps one write() small and the memory of a reader bounded.
inline constexpr std::size_t kMostPayloadBytes = std::size_t{64} * 1024;

/// Received bytes, at least one; 12 + 12 x reads + bytes must not exceed kMostPayloadBytes.
struct RxChunk {
    std::vector<std::byte> bytes;
    std::vector<ReadStamp> reads;  ///< Rising `end`; the last one is bytes.size().
};
/// Bytes of a command sent to the sensor.
struct TxChunk {
    RawTime time;
    std::vector<std::byte> bytes;
};
/// Time of a sample by the sample clock in force.
struct ModelChunk {
    std::int64_t index = 0;  ///< Sample to which `time` belongs.
    timing::SampleTime time;
};
struct EventChunk {
    std::string json;  ///< One object, as in the event log.
};
/// State of one channel in the archive.
struct ChannelMark {
    std::string channel;
    std::int64_t index = 0;  ///< Last sample that is archived and synced.
    UtcTime utc;             ///< Time of that sample.
};
struct MarkChunk {
    SessionId session;
    std::vector<ChannelMark> channels;
};

/// Outcome of a poll of the oven's controller.
enum class OvenOutcome : std::uint8_t {
    answered = 0,
    timed_out = 1,   ///< No complete answer within the time-out.
    bad_crc = 2,     ///< Bytes that are not a frame.
    exception = 3,   ///< The controller refused the read.
    other_unit = 4,  ///< Complete answer of another unit than the addressed one.
    malformed = 5,   ///< Complete answer of the addressed unit, but not to this request.
    no_port = 6,     ///< The port is absent, in use by another program, or was lost.
};
inline constexpr std::size_t kOvenOutcomeCount = 7;

/// One poll of the oven's controller.
struct OvenChunk {
    RawTime time;  ///< Right after the answer, or when the poll was given up.
    OvenOutcome outcome = OvenOutcome::answered;
    std::uint8_t decimals = 1;  ///< Decimals of process value and set point.
    /// Registers in the order of oven::Monitor; empty unless answered; at most 255.
    std::vector<std::uint16_t> registers;
};

using JournalChunk = std::variant<JournalHeader, RxChunk, TxChunk, timing::ClockReading, ModelChunk,
                                  EventChunk, MarkChunk, OvenChunk>;

}  // namespace a351::record
