#pragma once
/// @file
/// Content of the journal: the raw received bytes with their arrival times, and everything needed
/// to interpret them later.  Bytes on disk: protocol/journal/journal-format.md.
///
/// The journal is the original record; the archive is derived from it and can be made again.  A
/// journal is a row of segments.  Each segment begins with a Header, and chunks of the other
/// types follow in the order in which they were written.
///
/// Write it with Writer, read it with Sequence.  This header has the types only; all
/// are plain values without references to each other.
///
/// Times: RawTime is the host's CLOCK_MONOTONIC_RAW and has a meaning only within one boot of the
/// host, Header::boot_id.  The chunks of clock readings relate it to UTC.  Times of chunks
/// need not ascend: a header's reading can be later than the reads in the chunk after it.

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
#include "protocol/wire/start_up_test.hpp"

namespace a351::journal {

/// Random identifier of one run of sampling in which the counter is continuous.
///
/// A session may extend over several segments.  A default-constructed identifier is all zeros.  The
/// order of identifiers has no meaning; it serves containers.
struct SessionId {
    std::array<std::uint8_t, 16> bytes{};

    /// Returns 32 hexadecimal digits, lower case, first byte first.
    [[nodiscard]] std::string to_hex() const;
    /// Returns the identifier with these digits; the inverse of to_hex().
    /// @return std::nullopt unless the text is exactly 32 digits 0-9 a-f; upper case is refused.
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
/// Two axes with the same letter are not refused.
[[nodiscard]] bool are_valid(const StationCodes& codes) noexcept;

/// Chunks of an earlier segment, from chunk `sequence` on.
struct RepeatedChunks {
    /// Number of that segment, segment_number().
    std::uint64_t segment = 0;
    /// Sequence number of the first repeated chunk; chunk 1 of the repeating segment is the same.
    std::uint32_t sequence = 0;

    bool operator==(const RepeatedChunks&) const = default;
};

/// Limits of the sample interval of the oven's channels in the archive.
inline constexpr std::chrono::seconds kShortestOvenInterval{1}, kLongestOvenInterval{3600};

/// Limits of the age at which a record of the sampled channels ends.
inline constexpr std::chrono::seconds kShortestRecordAge{1}, kLongestRecordAge{60};

/// Header of every segment, so that a reader needs only the file.
///
/// A default-constructed header can be encoded, but it has no profile, rate or layout.  Frames
/// cannot be decoded with it.
struct Header {
    SessionId session;
    std::string boot_id;  ///< Boot of the kernel, which defines the zero of the raw clock.
    std::string program_version;
    StationCodes codes;
    std::string profile;  ///< Name of the wire::DeviceProfile.
    /// Identity as the device reported it.  Bytes that are not UTF-8 become U+FFFD on disk.
    std::string product_id;
    std::string serial_number;
    std::uint16_t firmware = 0;
    /// True if the device was already sampling and was not queried: product, serial number and
    /// firmware are those of the session before.
    bool is_device_assumed = false;
    /// Result of the sensor's last start-up test, which may be before this session.
    wire::StartUpTest start_up_test = wire::StartUpTest::passed;
    std::string port;  ///< Configured path or USB identity; empty if there is none.
    /// Nominal rate of the frames, 1/s; wire::DeviceProfile::has_output_rate() must accept it.
    int output_rate_hz = 0;
    /// Name within the profile, wire::DeviceProfile::filter_named().  It determines the delay.
    std::string filter;
    /// Fields of each frame, wire::BurstLayout::from_burst_ctrl().
    std::uint16_t burst_ctrl = 0;
    /// Rate of the line, bits per second, 10 bits per byte.  It determines the time of a frame.
    int baud = 0;
    std::optional<double> declared_rate_hz;  ///< Rate of blockette 100; absent until commissioned.
    std::chrono::seconds oven_interval{1};   ///< Sample interval of the oven's channels.
    /// Age of its oldest sample at which a record of the sampled channels ends.
    std::chrono::seconds record_age = kLongestRecordAge;
    std::chrono::seconds outer_oven_interval{1};  ///< The same of the outer oven's channels.
    /// Reading of the host's clocks for this segment: the first that a reader gets.  Its UTC is the
    /// time in the file name.
    timing::ClockReading clock;
    /// Earlier chunks that the first chunks of this segment repeat, because their sync failed.
    /// Set by Writer, evaluated by Repetitions.
    std::optional<RepeatedChunks> repeats;
};

/// Returns true if a stream with header `next` is read in the same way as one with `last`, by the
/// same host clock.  Only then can it continue the session.
///
/// It compares boot_id, codes, profile, output_rate_hz, filter, burst_ctrl and baud.  Session and
/// identity of the device are not compared: do so yourself if they matter.
[[nodiscard]] bool is_same_stream(const Header& last, const Header& next);

// Limits of the values in a journal.  Raw time has the limits of UTC, because it counts like UTC on
// simulated time.  Within these limits an instant plus a difference of two others is below 2^63 ns.
// decode_payload() and parse_header() refuse values outside them; encode_chunk() does not.
inline constexpr Nanoseconds kEarliestInstant{-(std::int64_t{1} << 58U)};   ///< Year 1960.
inline constexpr Nanoseconds kLatestInstant{3'900'000'000'000'000'000};     ///< Year 2093.
inline constexpr Nanoseconds kLongestSpan{std::int64_t{1} << 58U};          ///< 9 years.
inline constexpr std::int64_t kMostClockError_us = std::int64_t{1} << 47U;  ///< 4 years.
/// Sample index, 2^53: every index up to it is exact as a double.
inline constexpr std::int64_t kLargestIndex = std::int64_t{1} << 53U;

/// Returns true if all times and errors are within these limits.  The limits themselves are
/// permitted; errors may be negative.
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
///
/// Frames are not aligned with chunks or reads: feed the bytes of all chunks of a session to one
/// wire::BurstDecoder.  The first read has the bytes from 0, each other one those from the end of
/// the read before.  Their times are kept as they were taken, even if a clock went back.
struct RxChunk {
    std::vector<std::byte> bytes;
    std::vector<ReadStamp> reads;  ///< Rising `end`; the last one is bytes.size().
};
/// Bytes of a command sent to the sensor.
struct TxChunk {
    /// Raw time at which the bytes were sent.
    RawTime time;
    /// One command, or a lone CR; they are for diagnosis and do not change how frames are read.
    std::vector<std::byte> bytes;
};
/// Time of a sample by the sample clock in force.
///
/// It shows later how well the times were known at that moment.  The archiver does not use it: it
/// computes times from reads and clock readings.  `time.is_host_synchronised` is not stored and is
/// read as false, and an uncertainty beyond kLongestSpan is stored as kLongestSpan.
struct ModelChunk {
    std::int64_t index = 0;  ///< Sample to which `time` belongs.
    timing::SampleTime time;
};
/// Copy of an entry of the event log; protocol/events/event-format.md.  The log itself is the
/// authority.
struct EventChunk {
    /// Text in UTF-8; neither reader nor writer of the journal parses it.
    std::string json;  ///< One object, as in the event log.
};
/// State of one channel in the archive.
struct ChannelMark {
    /// Code of the channel, such as "BNZ"; at most 255 characters.
    std::string channel;
    std::int64_t index = 0;  ///< Last sample that is archived and synced.
    UtcTime utc;             ///< Time of that sample.
};
/// Progress of the archive.  Recovery begins at the session that the newest mark names; sessions
/// before it are complete in the archive.
struct MarkChunk {
    /// Session to which the indices belong.  It can be an earlier one than the segment's, because
    /// the archive is written later than the journal.
    SessionId session;
    /// Channels with archived samples, each once; may be empty.
    std::vector<ChannelMark> channels;
};

/// Outcome of a poll of the oven's controller.
///
/// `no_port` concerns the host; `timed_out` the cable, the power or the settings of the line.  In
/// the cases between them something is received, but no valid answer: check baud rate, parity, unit
/// number, and other units on the line.
enum class OvenOutcome : std::uint8_t {
    answered = 0,
    timed_out = 1,   ///< No complete answer within the time-out.
    bad_crc = 2,     ///< Bytes that are not a frame.
    exception = 3,   ///< The controller refused the read.
    other_unit = 4,  ///< Complete answer of another unit than the addressed one.
    malformed = 5,   ///< Complete answer of the addressed unit, but not to this request.
    no_port = 6,     ///< The port is absent, in use by another program, or was lost.
};
/// Number of outcomes: the size of an array indexed by OvenOutcome.
inline constexpr std::size_t kOvenOutcomeCount = 7;

/// Ovens of a double oven, from the inside.  A single oven is the inner one.
enum class OvenPlace : std::uint8_t { inner, outer };

/// One poll of an oven's controller.
struct OvenChunk {
    RawTime time;  ///< Right after the answer, or when the poll was given up.
    OvenOutcome outcome = OvenOutcome::answered;
    std::uint8_t decimals = 1;  ///< Decimals of process value and set point.
    /// Registers in the order of oven::Monitor; empty unless answered; at most 255.
    /// oven::controller_values() converts them, with `decimals`.
    std::vector<std::uint16_t> registers;
    OvenPlace place = OvenPlace::inner;  ///< On disk it is the type of the chunk.
};

/// Any chunk of a segment.  The order of the alternatives is part of the format, see ChunkType.
using Chunk = std::variant<Header, RxChunk, TxChunk, timing::ClockReading, ModelChunk, EventChunk,
                           MarkChunk, OvenChunk>;

}  // namespace a351::journal
