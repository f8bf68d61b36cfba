#pragma once
/// @file
/// Samples of the archive, with the times their records give them.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Samples without a gap: neighbouring records that join within half a sample.  Each record's own
/// start time is kept, because time at the header rate runs away from it.
struct Segment {
    struct Anchor {
        std::size_t offset = 0;  ///< Sample within `counts` ...
        UtcTime time;            ///< ... and its time.
    };
    double rate_hz = 0.0;
    std::vector<std::int32_t> counts;
    std::vector<Anchor> anchors;  ///< One per record, ascending; the first has offset 0.

    [[nodiscard]] UtcTime time_of(std::size_t i) const;  ///< From the anchor at or before i.
};

/// Damage met while reading: bytes that are no record of the channel.
struct ArchiveDamage {
    std::filesystem::path file;
    std::uint64_t offset = 0;
    std::uint64_t byte_count = 0;
};

/// "FILE: offset O: N bytes are no record", FILE without its folder.
[[nodiscard]] std::string to_text(const ArchiveDamage& damage);

struct ChannelData {
    std::vector<Segment> segments;  ///< In time order.
    std::vector<ArchiveDamage> damage;
};

/// Samples of one channel within [from, to), as the time of each says, from `<archive>/YEAR/NET/STA/CHAN.D/...`.
/// Days without a file are simply absent.  Damage is passed over to the next record, at any offset.
/// @throws std::system_error  a file cannot be read.
[[nodiscard]] ChannelData read_channel(const std::filesystem::path& archive,
                                       const StationCodes& codes, const std::string& channel,
                                       UtcTime from, UtcTime to);

}  // namespace a351::record
