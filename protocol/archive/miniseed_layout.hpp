#pragma once
/// @file
/// Offsets of the fields in the miniSEED records of this archive; all fields are big-endian.  FDSN,
/// SEED reference manual 2.4, chapter 8 (fixed section of data header; blockettes 100, 1000, 1001).
/// A table for readers: protocol/archive/archive-format.md.

#include <cstddef>
#include <cstdint>

namespace a351::record {

// Fixed section of data header, byte 0 ... 47.
inline constexpr std::size_t kSequenceAt = 0;  ///< 6 digits.
inline constexpr std::size_t kQualityAt = 6;   ///< 'D', then a blank.
/// Codes, padded with blanks: station 5 characters, location 2, channel 3, network 2.
inline constexpr std::size_t kStationAt = 8;
inline constexpr std::size_t kYearAt = 20;            ///< u16
inline constexpr std::size_t kDayOfYearAt = 22;       ///< u16, 1 ... 366.
inline constexpr std::size_t kHourAt = 24;            ///< u8, then minute and second.
inline constexpr std::size_t kFractionAt = 28;        ///< u16, 0.0001 s.
inline constexpr std::size_t kSampleCountAt = 30;     ///< u16
inline constexpr std::size_t kRateFactorAt = 32;      ///< i16
inline constexpr std::size_t kRateMultiplierAt = 34;  ///< i16
inline constexpr std::size_t kActivityFlagsAt = 36;   ///< u8
inline constexpr std::size_t kClockFlagsAt = 37;      ///< u8, I/O and clock.
inline constexpr std::size_t kQualityFlagsAt = 38;    ///< u8
inline constexpr std::size_t kBlocketteCountAt = 39;  ///< u8
inline constexpr std::size_t kCorrectionAt = 40;      ///< i32, always 0.
inline constexpr std::size_t kDataOffsetAt = 44;      ///< u16
inline constexpr std::size_t kFirstBlocketteAt = 46;  ///< u16

// Blockettes: type u16, offset of the next one u16, content.
inline constexpr std::size_t kBlockette1000At = 48;  ///< Coding, byte order, log2(size), reserved.
inline constexpr std::size_t kBlockette1001At = 56;  ///< Timing quality, microseconds i8, 0, 0.
inline constexpr std::size_t kBlockette100At = 64;   ///< Rate f32, flags, 3 reserved.
inline constexpr std::size_t kBlockette100End = 76;
inline constexpr std::size_t kSteimFrameSize = 64;

inline constexpr std::uint8_t kCodingInt32 = 3;
inline constexpr std::uint8_t kCodingSteim2 = 11;
inline constexpr std::uint8_t kBigEndian = 1;
inline constexpr std::uint8_t kLog2RecordSize = 9;

// I/O and clock flags.
inline constexpr std::uint8_t kStartOfSeries = 1U << 3;
inline constexpr std::uint8_t kEndOfSeries = 1U << 4;
inline constexpr std::uint8_t kClockLocked = 1U << 5;
// Data quality flags.
inline constexpr std::uint8_t kClipped = 1U << 1;
inline constexpr std::uint8_t kSynchronisationError = 1U << 5;
inline constexpr std::uint8_t kTimeTagQuestionable = 1U << 7;

}  // namespace a351::record
