#pragma once
/// @file
/// Samples of the archive, with the times of their records.
///
/// Use it for every computation on recorded data.  It finds the day files, skips damage and joins
/// records without a gap between them.
///
///     const ChannelData data = read_channel(archive, codes, "BNZ", from, to);
///     for (const Segment& segment : data.segments)
///         for (std::size_t i = 0; i < segment.counts.size(); ++i)
///             use(segment.time_of(i), scale.offset + scale.gain * segment.counts[i]);
///
/// The scale is that of read_station_xml().  No file is changed; the daemon may write meanwhile.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::archive {

/// Samples without a gap: records of which each starts within half a sample of the end of the one
/// before.  The start time of each record is kept, because the header rate drifts away from it.
///
/// The sizes of `counts` and `anchors` are at least 1 in a result of read_channel().
struct Segment {
    /// First sample of a record within the interval that was read.
    struct Anchor {
        std::size_t offset = 0;  ///< Sample within `counts`.
        UtcTime time;            ///< Time of that sample.
        /// The time is uncertain by more than 10 ms, or the host's clock was not synchronised.
        bool is_time_questionable = false;
        int timing_quality_percent = 100;  ///< timing_quality_percent() of its uncertainty.
    };
    double rate_hz = 0.0;              ///< Rate of blockette 100, else of the fixed header, Hz.
    std::vector<std::int32_t> counts;  ///< Raw counts (n), one sample after the other.
    std::vector<Anchor> anchors;       ///< One per record, ascending; the first has offset 0.

    /// Returns the time of sample i, from the last anchor at or before it.
    ///
    ///     anchor.time + (i - anchor.offset) / rate_hz
    ///
    /// From one record to the next the times jump by half a sample at most.  An i beyond the last
    /// sample is extrapolated.  O(log m) for m anchors.  Precondition: `anchors` is not empty.
    [[nodiscard]] UtcTime time_of(std::size_t i) const;
};

/// Damage found while reading: bytes that are not a record of the channel.  Samples of damaged
/// records are missing; those before and after them are read.
struct Damage {
    std::filesystem::path file;    ///< Day file, with its folders.
    std::uint64_t offset = 0;      ///< First damaged byte, from the begin of the file.
    std::uint64_t byte_count = 0;  ///< Bytes up to the next record, or to the end of the file.
    bool is_of_another_station = false;  ///< A record with other codes of network or station.
};

/// Returns "FILE: offset O: N bytes are not a record" or "... are a record of another station",
/// FILE without its folder.
[[nodiscard]] std::string to_text(const Damage& damage);

/// A day file that a channel lacks.
struct AbsentFile {
    std::string channel;
    UtcTime day;  ///< Begin of the day.
    /// The file compressed, beside its place; empty: there is none.
    std::filesystem::path compressed = {};

    bool operator==(const AbsentFile&) const = default;
};

/// A rate in the headers of records that is not that of the metadata.
struct RateConflict {
    std::string channel;
    double header_hz = 0.0, metadata_hz = 0.0;
    double observed_hz = 0.0;  ///< Samples over time between the starts of records, the median.
    double used_hz = 0.0;  ///< That of the metadata if the starts agree, else that of the headers.
    double longest_s = 0.0;  ///< Duration of the longest record, by the starts.
};

/// Result of read_channel().
struct ChannelData {
    std::vector<Segment> segments;  ///< In time order.
    /// Damage of all day files read, also outside the interval, in the order of the files.
    std::vector<Damage> damage;
    std::optional<RateConflict> rate_conflict = {};
};

/// Reads the samples of one channel whose times lie within [from, to), from
/// `<archive>/YEAR/NET/STA/CHAN.D/...`.  A day without a file is a gap.  Damage is skipped up to
/// the next record, at any offset.
///
/// A record that is in its file twice, as in a merged copy, counts once: its number (the first six
/// bytes) may differ.
///
/// A gap or an overlap of more than half a sample begins a new segment, and another rate too.
/// After the host's clock was set back, segments may overlap; nothing is removed.  Gaps, overlaps,
/// midnight, damage and stepped clocks: archive_reader_test.cpp.
///
/// A missing archive or channel gives no segments and no error, and so does from >= to.  The
/// interval may exceed the archive, for example UtcTime::min() to UtcTime::max().
///
/// Cost: each day file of the interval is read once, in pieces.  Thread-safe.
/// @param codes    valid codes, see are_valid(); they become parts of the path.
/// @param channel  channel code, e.g. BNZ; records of another channel in its files are damage.
/// @param metadata_hz  rate of the metadata, if it is known.  If headers have another one by more than
///                     0.1 %, the starts of the records decide which is used.
/// @param memory   for the first segment, instead of new memory; what is in it is lost.
/// @throws std::system_error  a file cannot be read.
[[nodiscard]] ChannelData read_channel(const std::filesystem::path& archive,
                                       const journal::StationCodes& codes,
                                       const std::string& channel, UtcTime from, UtcTime to,
                                       std::optional<double> metadata_hz = {},
                                       std::vector<std::int32_t> memory = {});

/// Returns the day files in [from, to) that some of these channels have and others lack, in order of
/// time: they were lost, as by a copy that is not complete.
///
/// On a running day one channel has its first record before another.  So a day counts when a channel
/// has twice journal::kLongestRecordAge of it.  A file that is there in compressed form always
/// counts.
/// @throws std::system_error  a file cannot be read.
[[nodiscard]] std::vector<AbsentFile> absent_day_files(const std::filesystem::path& archive,
                                                       const journal::StationCodes& codes,
                                                       const std::vector<std::string>& channels,
                                                       UtcTime from, UtcTime to);

}  // namespace a351::archive
