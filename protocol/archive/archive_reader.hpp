#pragma once
/// @file
/// Samples of the archive, with the times of their records.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Samples without a gap: records of which each starts within half a sample of the end of the one
/// before.  The start time of each record is kept, because the header rate drifts away from it.
struct Segment {
    struct Anchor {
        std::size_t offset = 0;  ///< Sample within `counts`.
        UtcTime time;            ///< Time of that sample.
    };
    double rate_hz = 0.0;
    std::vector<std::int32_t> counts;
    std::vector<Anchor> anchors;  ///< One per record, ascending; the first has offset 0.

    /// Returns the time of sample i, from the last anchor at or before it.
    [[nodiscard]] UtcTime time_of(std::size_t i) const;
};

/// Damage found while reading: bytes that are not a record of the channel.
struct ArchiveDamage {
    std::filesystem::path file;
    std::uint64_t offset = 0;
    std::uint64_t byte_count = 0;
};

/// Returns "FILE: offset O: N bytes are not a record", FILE without its folder.
[[nodiscard]] std::string to_text(const ArchiveDamage& damage);

struct ChannelData {
    std::vector<Segment> segments;  ///< In time order.
    std::vector<ArchiveDamage> damage;
};

/// Reads the samples of one channel whose times lie within [from, to), from
/// `<archive>/YEAR/NET/STA/CHAN.D/...`.  A day without a file is a gap.  Damage is skipped up to
/// the next record, at any offset.
/// @throws std::system_error  a file cannot be read.
[[nodiscard]] ChannelData read_channel(const std::filesystem::path& archive,
                                       const StationCodes& codes, const std::string& channel,
                                       UtcTime from, UtcTime to);

}  // namespace a351::record
