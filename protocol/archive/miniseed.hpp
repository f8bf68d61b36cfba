#pragma once
/// @file
/// One miniSEED 2 record of 512 bytes: integer samples, Steim-2 where it fits, otherwise 32-bit
/// integers.  FDSN, SEED reference manual 2.4, chapter 8.  libmseed does the coding.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::record {

inline constexpr std::size_t kRecordSize = 512;

struct RecordHeader {
    std::string network, station, location, channel;
    int sequence = 1;                        ///< 1 ... 999999.
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
};

struct PackedRecord {
    std::array<std::byte, kRecordSize> bytes{};
    std::size_t sample_count = 0;  ///< Number of samples packed, from the first on.
    bool is_integer_coded = false;
    UtcTime start;
};

/// Packs as many of the first samples as one record holds.  The order of blockettes is 1000, 1001,
/// 100, because SeedLink clients look for 1000 within the first bytes.
///
/// Steim-2 cannot code a difference of 2^29 or more between neighbours: the record ends before it.
/// If such jumps follow each other, the samples between them are coded as integers.
/// @param samples  at least one.
/// @throws std::invalid_argument  no samples, or a header field out of range.
[[nodiscard]] PackedRecord pack_record(const RecordHeader& header,
                                       std::span<const std::int32_t> samples);

/// Largest number of samples of a record: seven Steim-2 frames of 15 words, less two words for the
/// first and last sample, seven differences per word.
inline constexpr std::size_t kMostSamplesPerRecord = (std::size_t{7} * 15 - 2) * 7;

struct DecodedRecord {
    RecordHeader header;
    std::vector<std::int32_t> samples;

    /// Returns the rate of blockette 100 if present, else that of the fixed header.
    [[nodiscard]] double rate_hz() const;
};

/// Reads a record written by pack_record(), not any miniSEED: the header is checked to the byte,
/// Steim-2 by its first and last sample.  Thread-safe, like pack_record().
/// @return std::nullopt unless the bytes are one whole valid record of kRecordSize.
[[nodiscard]] std::optional<DecodedRecord> decode_record(std::span<const std::byte> bytes);

/// Finds the next record of a channel.  Every offset is tried, because stray bytes may have shifted
/// all later records.
/// @param at  where to begin; afterwards the end of the record, or of the bytes if there is none.
[[nodiscard]] std::optional<DecodedRecord> next_record(std::span<const std::byte> bytes,
                                                       const std::string& channel, std::size_t& at);

/// Returns the timing quality in percent: 100 for an uncertainty up to 1 ms, then 20 less per
/// decade (20 at 10 s, 0 from 100 s on).
[[nodiscard]] int timing_quality_percent(Nanoseconds uncertainty);

}  // namespace a351::record
