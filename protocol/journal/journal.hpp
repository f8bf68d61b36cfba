#pragma once
/// @file
/// What the journal holds: the raw received bytes with their arrival times, and all that is needed
/// to read them later.  Bytes on disk: protocol/journal/journal-format.md.

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

/// Names one run of sampling in which the counter is continuous.  Random.
struct SessionId {
    std::array<std::uint8_t, 16> bytes{};

    [[nodiscard]] std::string to_hex() const;
    [[nodiscard]] static std::optional<SessionId> from_hex(std::string_view text);
    auto operator<=>(const SessionId&) const = default;
};

/// Codes that name a sensor in SEED, and the channel suffix of each axis.
struct StationCodes {
    std::string network = "XX";                      ///< 1-2 characters A-Z 0-9.
    std::string station = "A351";                    ///< 1-5 characters A-Z 0-9.
    std::string location = "00";                     ///< 2 characters, or empty.
    std::array<std::string, 3> axes{"1", "2", "Z"};  ///< Last letter of x, y, z.

    bool operator==(const StationCodes&) const = default;
};

/// Whether each has the characters and the length said there.  They name directories: others than
/// these must not come out of a file.
[[nodiscard]] bool are_valid(const StationCodes& codes) noexcept;

/// Chunks of an earlier segment, from `sequence` on.
struct RepeatedChunks {
    std::uint64_t segment = 0;
    std::uint32_t sequence = 0;

    bool operator==(const RepeatedChunks&) const = default;
};

/// Of the oven's channels in the archive.
inline constexpr std::chrono::seconds kShortestOvenInterval{1}, kLongestOvenInterval{3600};

/// Heads every segment: a reader needs nothing but the file.
struct JournalHeader {
    SessionId session;
    std::string boot_id;  ///< Of the kernel: names the raw clock's zero.
    std::string program_version;
    StationCodes codes;
    std::string profile;  ///< wire::DeviceProfile by name.
    std::string product_id;
    std::string serial_number;
    std::uint16_t firmware = 0;
    /// The stream ran already: the device was not asked, product, serial number and firmware are
    /// those of the session before.
    bool is_device_assumed = false;
    std::string port;  ///< As configured: path or USB identity; empty where there is none.
    int output_rate_hz = 0;
    std::string filter;
    std::uint16_t burst_ctrl = 0;
    int baud = 0;
    std::optional<double> declared_rate_hz;  ///< For blockette 100; absent until commissioned.
    std::chrono::seconds oven_interval{1};   ///< From sample to sample of the oven's channels.
    timing::ClockReading clock;
    /// What the first chunks of this segment repeat, because its sync failed there.
    std::optional<RepeatedChunks> repeats;
};

/// Whether a stream under `next` reads as one under `last`, by the same host clock: only then can it
/// go on in the session.
[[nodiscard]] bool is_same_stream(const JournalHeader& last, const JournalHeader& next);

// What a journal can hold.  Raw time counts as UTC does when time is simulated.  Within these bounds
// an instant and a difference of two others add up to less than 2^63 ns.
inline constexpr Nanoseconds kEarliestInstant{-(std::int64_t{1} << 58U)};   ///< 1960.
inline constexpr Nanoseconds kLatestInstant{3'900'000'000'000'000'000};     ///< 2093.
inline constexpr Nanoseconds kLongestSpan{std::int64_t{1} << 58U};          ///< 9 years.
inline constexpr std::int64_t kMostClockError_us = std::int64_t{1} << 47U;  ///< 4 years.
inline constexpr std::int64_t kLargestIndex = std::int64_t{1} << 53U;

[[nodiscard]] bool is_in_range(const timing::ClockReading& clock) noexcept;

/// One read() of the port: its bytes end at `end` within the chunk.
struct ReadStamp {
    std::uint32_t end = 0;
    RawTime time;  ///< Taken right after read() returned.

    bool operator==(const ReadStamp&) const = default;
};

/// A chunk on disk holds at most this, so that one write() stays small and a reader's memory bounded.
inline constexpr std::size_t kMostPayloadBytes = std::size_t{64} * 1024;

/// Holds 1 byte or more; 12 + 12 x reads + bytes must stay within kMostPayloadBytes.
struct RxChunk {
    std::vector<std::byte> bytes;
    std::vector<ReadStamp> reads;  ///< Rising `end`; the last one is bytes.size().
};
struct TxChunk {
    RawTime time;
    std::vector<std::byte> bytes;
};
struct ModelChunk {
    std::int64_t index = 0;  ///< Sample that `time` belongs to.
    timing::SampleTime time;
};
struct EventChunk {
    std::string json;  ///< One object, as in the event log.
};
struct ChannelMark {
    std::string channel;
    std::int64_t index = 0;  ///< Last sample that is archived and synced.
    UtcTime utc;
};
struct MarkChunk {
    SessionId session;
    std::vector<ChannelMark> channels;
};

/// What became of a poll of the oven's controller.
enum class OvenOutcome : std::uint8_t {
    answered = 0,
    timed_out = 1,   ///< No answer, or not all of one, within the time-out.
    bad_crc = 2,     ///< Bytes that are no frame.
    exception = 3,   ///< The controller refuses the read.
    other_unit = 4,  ///< A whole answer of a unit that was not asked.
    malformed = 5,   ///< A whole answer of the unit asked, but not to this question.
    no_port = 6,     ///< The port is absent, held by others, or was lost.
};
inline constexpr std::size_t kOvenOutcomeCount = 7;

/// One poll of the oven's controller.
struct OvenChunk {
    RawTime time;  ///< Right after the answer, or when it was given up.
    OvenOutcome outcome = OvenOutcome::answered;
    std::uint8_t decimals = 1;  ///< Of process value and set point.
    /// In the order of oven::Monitor; empty unless answered; at most 255.
    std::vector<std::uint16_t> registers;
};

using JournalChunk = std::variant<JournalHeader, RxChunk, TxChunk, timing::ClockReading, ModelChunk,
                                  EventChunk, MarkChunk, OvenChunk>;

}  // namespace a351::record
