#pragma once
/// @file
/// One miniSEED 2 record of 512 bytes: integer samples, Steim-2 where it fits, otherwise 32-bit
/// integers.  FDSN, SEED reference manual 2.4, chapter 8.  libmseed does the coding.
///
/// One record holds a part of a long series only.  The caller packs the rest:
///
///     while (!samples.empty()) {
///         header.start = time_of_first(samples);
///         const PackedRecord record = pack_record(header, samples);
///         write(record.bytes);
///         samples = samples.subspan(record.sample_count);
///     }
///
/// All functions are thread-safe: a lock protects libmseed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::archive {

/// Size of every record of the archive, bytes.  Day files are multiples of it.
inline constexpr std::size_t kRecordSize = 512;

/// Largest sequence number of a record; 1 follows it.
inline constexpr int kLargestSequence = 999'999;

/// Header of a record, without the fields that follow from its samples.  archive-format.md says
/// when each flag is set.
struct RecordHeader {
    /// SEED codes of at most 2, 5, 2 and 3 characters A-Z 0-9; not checked.
    std::string network, station, location, channel;
    int sequence = 1;                        ///< 1 ... kLargestSequence.
    UtcTime start;                           ///< Time of the first sample; rounded to 1 us.
    Hertz nominal_rate;                      ///< Rate of the fixed header: n or 1 / n Hz.
    std::optional<double> declared_rate_hz;  ///< Blockette 100, as the nearest 32-bit float.
    bool is_clock_locked = false;            ///< I/O and clock flags, bit 5.
    bool starts_series = false;              ///< I/O and clock flags, bit 3.
    bool ends_series = false;                ///< I/O and clock flags, bit 4.
    bool is_clipped = false;                 ///< Data quality flags, bit 1.
    bool had_transmission_errors = false;    ///< Data quality flags, bit 5.
    bool is_time_questionable = false;       ///< Data quality flags, bit 7.
    int timing_quality_percent = 0;          ///< Blockette 1001.

    /// Returns the rate as a reader finds it: the declared one if present.
    [[nodiscard]] double rate_hz() const {
        return declared_rate_hz ? static_cast<double>(static_cast<float>(*declared_rate_hz))
                                : nominal_rate.value();
    }
};

/// Result of pack_record(); default-constructed it is no record.
struct PackedRecord {
    /// Record as it is written to disk.
    std::array<std::byte, kRecordSize> bytes{};
    std::size_t sample_count = 0;   ///< Number of samples packed, from the first on.
    bool is_integer_coded = false;  ///< True for 32-bit integers, false for Steim-2.
    UtcTime start;                  ///< Start time in the record: the header's, rounded to 1 us.
};

/// Packs as many of the first samples as one record holds.  The order of blockettes is 1000, 1001,
/// 100, because SeedLink clients look for 1000 within the first bytes.
///
/// Steim-2 cannot code a difference of 2^29 or more between neighbours: the record ends before it.
/// If such jumps follow each other, the samples between them are coded as integers.
///
/// A record has at most 721 samples (616 with a declared rate) in Steim-2, 112 (109) as integers.
/// Every 32-bit value is preserved (miniseed_test.cpp, "any 32-bit integers come back unchanged").
/// The same input gives the same bytes.
/// @param header   a timing quality outside 0 to 100 % is clamped.
/// @param samples  at least one, without a gap; those that do not fit are ignored.
/// @throws std::invalid_argument  no samples, or a header field out of range.
/// @throws std::bad_alloc         no memory.
[[nodiscard]] PackedRecord pack_record(const RecordHeader& header,
                                       std::span<const std::int32_t> samples);

/// Largest number of samples of a record: seven Steim-2 frames of 15 words, less two words for the
/// first and last sample, seven differences per word.
inline constexpr std::size_t kMostSamplesPerRecord = (std::size_t{7} * 15 - 2) * 7;

/// Content of a record; sample i has the time header.start + i / rate_hz().
struct DecodedRecord {
    RecordHeader header;
    std::vector<std::int32_t> samples;  ///< Raw counts, at least one from decode_record().

    /// Returns the rate of blockette 100 if present, else that of the fixed header, in Hz.
    [[nodiscard]] double rate_hz() const { return header.rate_hz(); }
    /// Returns the time of the last sample.
    [[nodiscard]] UtcTime last_sample() const;
};

/// Reads a record written by pack_record(), not any miniSEED: every header field that determines
/// the shape is checked, Steim-2 by its first and last sample.  Thread-safe, like pack_record().
///
/// A record has no checksum: a flipped bit in a time, a flag or an integer sample is not detected.
/// A declared rate that differs from the nominal one by more than 10 % is damage.
/// @return std::nullopt unless the bytes are one whole valid record of kRecordSize.
[[nodiscard]] std::optional<DecodedRecord> decode_record(std::span<const std::byte> bytes);

/// A record among other bytes.
struct FoundRecord {
    std::uint64_t offset = 0;  ///< Its first byte.
    DecodedRecord record;
};

/// Finds the records of a channel.  Every offset is tried, because stray bytes may have shifted all
/// later records.
///
/// Most offsets are refused by a look at the header, so the cost is O(bytes) also for damaged
/// files.
/// @param channel  channel code; records of other channels are skipped.
[[nodiscard]] std::vector<FoundRecord> find_records(std::span<const std::byte> bytes,
                                                    const std::string& channel);

/// Returns the timing quality in percent: 100 for an uncertainty up to 1 ms, then 20 less per
/// decade (20 at 10 s, 0 from 100 s on).  The result is rounded to 1 %.
/// @param uncertainty  uncertainty of a time, 95 %; 0 and below give 100.
[[nodiscard]] int timing_quality_percent(Nanoseconds uncertainty);

}  // namespace a351::archive
