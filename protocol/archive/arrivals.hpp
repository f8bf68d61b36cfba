#pragma once
/// @file
/// Arrival time of each byte of a serial stream, from the times of the reads that delivered it.
///
/// A read is time-stamped when it returns, so its last byte has the time of the read.  Each byte
/// before it arrived one byte's wire time earlier.
///
///     arrivals.add(chunk);                                 // as the bytes go to the decoder
///     const RawTime arrival = arrivals.of(end, baud);      // end of a frame in the stream

#include <algorithm>
#include <cstdint>
#include <deque>

#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::archive {

/// Returns the time that `bytes` take on a serial line with 8N1, ten bits each.  @param baud  > 0.
///
/// The result is rounded down to 1 ns: 24 bytes at 460 800 baud take 520 833 ns.
/// @param bytes  below 9e8; not checked.
[[nodiscard]] inline Nanoseconds wire_time(std::uint64_t bytes, int baud) {
    constexpr std::int64_t kBitTimesPerByte_ns = 10 * std::int64_t{1'000'000'000};
    return Nanoseconds(static_cast<std::int64_t>(bytes) * kBitTimesPerByte_ns / baud);
}

/// Arrival times of the bytes that no event of the decoder covers yet.
///
/// Memory: one entry per read whose bytes were not asked for yet.  Not thread-safe.
class Arrivals {
public:
    /// Adds the reads of a chunk, which follows the chunk before without a gap in the stream.
    void add(const journal::RxChunk& chunk) {
        for (const auto& read : chunk.reads) reads_.push_back({received_ + read.end, read.time});
        received_ += chunk.bytes.size();
    }
    /// Returns the arrival of the byte before stream offset `end`; `end` rises from call to call.
    /// Older reads are forgotten.  Precondition: a chunk was added.
    /// @param end   bytes since construction, at most those added; not checked.
    /// @param baud  > 0; not checked.
    [[nodiscard]] RawTime of(std::uint64_t end, int baud) {
        while (reads_.size() > 1 && reads_.front().end < end) reads_.pop_front();
        const auto& read = reads_.front();
        return read.time - wire_time(read.end - std::min(end, read.end), baud);
    }

private:
    struct Read {
        std::uint64_t end;
        RawTime time;
    };
    std::deque<Read> reads_;
    std::uint64_t received_ = 0;
};

}  // namespace a351::archive
