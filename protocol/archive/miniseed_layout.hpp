#pragma once
/// @file
/// Offsets of the fields in the miniSEED records of this archive; all fields are big-endian.  FDSN,
/// SEED reference manual 2.4, chapter 8 (fixed section of data header; blockettes 100, 1000, 1001).
/// A table for readers: protocol/archive/archive-format.md.
///
/// Only code that reads or changes single bytes of a record needs these constants, for example to
/// renumber it.  decode_record() reads a whole record and checks it.
///
/// Types: u8, u16 unsigned and i8, i16, i32 signed integers of that many bits, f32 an IEEE 754
/// number.  Offsets count from the begin of the record, in bytes.

#include <cstddef>
#include <cstdint>

namespace a351::archive {

// Fixed section of data header, byte 0 ... 47.
inline constexpr std::size_t kSequenceAt = 0;  ///< 6 digits.
inline constexpr std::size_t kQualityAt = 6;   ///< 'D', then a blank.
/// Codes, padded with blanks: station 5 characters, location 2, channel 3, network 2.
inline constexpr std::size_t kStationAt = 8;
inline constexpr std::size_t kYearAt = 20;            ///< u16
inline constexpr std::size_t kDayOfYearAt = 22;       ///< u16, 1 ... 366.
inline constexpr std::size_t kHourAt = 24;            ///< u8, then minute and second.
inline constexpr std::size_t kFractionAt = 28;        ///< u16, 0.0001 s.
inline constexpr std::size_t kSampleCountAt = 30;     ///< u16, at least 1.
inline constexpr std::size_t kRateFactorAt = 32;      ///< i16, Hz, or minus seconds per sample.
inline constexpr std::size_t kRateMultiplierAt = 34;  ///< i16, 1, or -1 for seconds per sample.
inline constexpr std::size_t kActivityFlagsAt = 36;   ///< u8, always 0.
inline constexpr std::size_t kClockFlagsAt = 37;      ///< u8, I/O and clock.
inline constexpr std::size_t kQualityFlagsAt = 38;    ///< u8
inline constexpr std::size_t kBlocketteCountAt = 39;  ///< u8, 2, or 3 with a declared rate.
inline constexpr std::size_t kCorrectionAt = 40;      ///< i32, always 0.
inline constexpr std::size_t kDataOffsetAt = 44;      ///< u16, 64, 76 or 128.
inline constexpr std::size_t kFirstBlocketteAt = 46;  ///< u16, always 48.

// Blockettes: type u16, offset of the next one u16, content.  The order 1000, 1001, 100 is fixed,
// because stream clients look for 1000 in the first 64 bytes.
inline constexpr std::size_t kBlockette1000At = 48;  ///< Coding, byte order, log2(size), reserved.
inline constexpr std::size_t kBlockette1001At = 56;  ///< Timing quality, microseconds i8, 0, 0.
inline constexpr std::size_t kBlockette100At = 64;   ///< Rate f32, flags, 3 reserved.
/// End of blockette 100, where integers begin in a record with a declared rate.
inline constexpr std::size_t kBlockette100End = 76;
/// Size of a Steim frame, bytes: 16 words of 32 bits.  Steim-2 data begin at a multiple of it.
inline constexpr std::size_t kSteimFrameSize = 64;

// Values in blockette 1000: coding of the samples, byte order, and size of the record.
inline constexpr std::uint8_t kCodingInt32 = 3;
inline constexpr std::uint8_t kCodingSteim2 = 11;
inline constexpr std::uint8_t kBigEndian = 1;
inline constexpr std::uint8_t kLog2RecordSize = 9;

// I/O and clock flags.
/// First and last record of a run of sampling.
inline constexpr std::uint8_t kStartOfSeries = 1U << 3;
inline constexpr std::uint8_t kEndOfSeries = 1U << 4;
/// Host synchronised and sample clock locked.
inline constexpr std::uint8_t kClockLocked = 1U << 5;
// Data quality flags.
/// Raw value at or beyond the rated range of the device, or flagged by it.
inline constexpr std::uint8_t kClipped = 1U << 1;
/// Frames rejected or bytes skipped during the record.
inline constexpr std::uint8_t kSynchronisationError = 1U << 5;
/// Time uncertain by more than 10 ms, or host not synchronised.
inline constexpr std::uint8_t kTimeTagQuestionable = 1U << 7;

}  // namespace a351::archive
