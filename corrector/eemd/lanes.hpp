#pragma once
/// @file
/// The widest vector of doubles of the instruction set for which the including file is compiled,
/// and one operation that the compiler's vector types lack: moving lanes by flags.  Bit j of a set
/// of flags belongs to lane j.
///
/// The number of lanes is 8 with AVX-512, 4 with AVX2 and 2 otherwise.  Loops are written for any
/// of them; kLanes divides 64, so that a word of 64 flags holds whole groups.
///
/// Operators on vectors are those of the compiler: +, -, *, / and comparisons, lane by lane.  Each
/// operation is rounded by itself.
///
/// All names are internal to the including file, because every instruction set has its own.
/// Include this header only in files that kernel_table.hpp combines.

#include <cstddef>
#include <cstdint>

#ifdef __SSE2__
#include <immintrin.h>
#endif

/// Marks a loop whose elements do not depend on each other, so that g++ makes vectors of it.  clang
/// does so without a pragma, and compares the addresses at run time.
#ifdef __clang__
#define A351_INDEPENDENT
#else
#define A351_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace a351::corrector::eemd {
namespace {

/// Number of doubles in a vector.  Reason: the width of the widest registers of the instruction
/// set.
#if defined(__AVX512F__)
constexpr std::size_t kLanes = 8;
#elif defined(__AVX2__)
constexpr std::size_t kLanes = 4;
#else
constexpr std::size_t kLanes = 2;  // NEON, SSE2; plain doubles elsewhere
#endif

/// Set of flags of all lanes: the lowest kLanes bits are 1.
constexpr std::uint64_t kAllFlags = (1U << kLanes) - 1;

/// Vector of kLanes doubles, aligned to its own size.  Use it for variables, not for access to
/// arrays.
typedef double Lanes __attribute__((vector_size(8 * kLanes)));
/// The same vector in memory, at any address of a double.  It may alias an array of doubles.
typedef double LanesAnywhere __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));
/// Vector of as many words of 64 bits.  A comparison of Lanes, cast to it, has all bits of a lane
/// set where the comparison is true.
typedef std::uint64_t Words __attribute__((vector_size(8 * kLanes)));

/// Returns from[0 ... kLanes - 1]; any address of a double will do.
inline Lanes load_lanes(const double* from) {
    return *reinterpret_cast<const LanesAnywhere*>(from);
}
/// Writes to[0 ... kLanes - 1]; any address of a double will do.
inline void store_lanes(double* to, Lanes value) { *reinterpret_cast<LanesAnywhere*>(to) = value; }
/// Returns a vector with the same value in every lane.
inline Lanes all_lanes(double value) { return value - Lanes{}; }

/// Returns the lanes first, first + 1 and so on.
inline Lanes counting_from(double first) {
    Lanes out = {};
    for (std::size_t j = 0; j < kLanes; ++j) out[j] = static_cast<double>(j);
    return out + first;
}

/// Returns the last lane of `before` and all lanes of `here` but the last.
inline Lanes last_and_front(Lanes before, Lanes here) {
#if defined(__AVX512F__)
    return __builtin_shufflevector(before, here, 7, 8, 9, 10, 11, 12, 13, 14);
#elif defined(__AVX2__)
    return __builtin_shufflevector(before, here, 3, 4, 5, 6);
#else
    return __builtin_shufflevector(before, here, 1, 2);
#endif
}

/// Returns the bitwise or of all lanes.
inline std::uint64_t any_of(Words words) {
    std::uint64_t all = 0;
    for (std::size_t j = 0; j < kLanes; ++j) all |= words[j];
    return all;
}

/// Returns the number of flags that are set.  Only the lowest kLanes bits may be set.
inline std::size_t count_flags(std::uint64_t flags) {
    if constexpr (kLanes == 2) return (flags & 1) + (flags >> 1 & 1);
    return static_cast<std::size_t>(__builtin_popcountll(flags));
}

/// Returns the flags of the lanes with a > b; a lane with a NaN has no flag.
inline std::uint64_t flags_of_greater(Lanes a, Lanes b) {
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a, b, _CMP_GT_OQ);
#elif defined(__AVX2__)
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<Lanes>(a > b)));
#elif defined(__SSE2__)
    return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<Lanes>(a > b)));
#else
    const Words greater = reinterpret_cast<Words>(a > b);
    return (greater[0] & 1) | (greater[1] & 2);
#endif
}

#ifdef __AVX2__

#ifdef __AVX512F__
/// Element of a row: a lane, or a half of a lane.
typedef std::uint8_t Index;  // 2 KiB of rows
constexpr std::size_t kParts = 1;
#else
typedef std::uint32_t Index;
constexpr std::size_t kParts = 2;  // halves of a double: no instruction moves whole ones
#endif

/// A table with one row for each set of flags: the indices of the lanes, or halves of lanes, that
/// become lanes 0, 1 and so on.
struct LaneTable {
    alignas(32) Index rows[kAllFlags + 1][8] = {};
};

/// Returns a table that gives lane j the lane whose number is the count of flags before j.
constexpr LaneTable make_behind_flags() {
    LaneTable table;
    for (std::uint64_t flags = 0; flags <= kAllFlags; ++flags) {
        std::size_t before = 0;
        for (std::size_t j = 0; j < kLanes; ++j) {
            for (std::size_t part = 0; part < kParts; ++part)
                table.rows[flags][kParts * j + part] = static_cast<Index>(kParts * before + part);
            before += flags >> j & 1;
        }
    }
    return table;
}
/// Rows for behind(), computed by the compiler.
constexpr LaneTable kBehindFlags = make_behind_flags();

#ifdef __AVX512F__

/// Order of lanes: lane j of the result is lane Order[j] of the values.
typedef __m512i Order;
/// Returns the order that gives lane j the lane whose number is the count of flags before lane j.
inline Order behind(std::uint64_t flags) {
    const void* const row = kBehindFlags.rows[flags];
    return _mm512_maskz_cvtepu8_epi64(kAllFlags, _mm_loadl_epi64(static_cast<const __m128i*>(row)));
}
/// Returns the lanes of `values` in an order.
// The mask with all flags costs nothing.  Without it g++ 12 warns of an uninitialised variable.
inline Lanes ordered(Lanes values, Order order) {
    return _mm512_maskz_permutexvar_pd(kAllFlags, order, values);
}
/// Returns the flagged lanes in front, in order; the lanes after them are 0.
inline Lanes flagged_first(Lanes values, std::uint64_t flags) {
    return _mm512_maskz_compress_pd(static_cast<__mmask8>(flags), values);
}

#else

/// Order of half lanes: half j of the result is half Order[j] of the values.
typedef __m256i Order;
/// Returns the row of a table for a set of flags.
inline Order row_of(const LaneTable& table, std::uint64_t flags) {
    const void* const row = table.rows[flags];
    return _mm256_load_si256(static_cast<const __m256i*>(row));
}
/// Returns the order that gives lane j the lane whose number is the count of flags before lane j.
inline Order behind(std::uint64_t flags) { return row_of(kBehindFlags, flags); }
/// Returns the lanes of `values` in an order.
inline Lanes ordered(Lanes values, Order order) {
    return _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(values), order));
}

/// Returns a table that moves the flagged lanes to the front.
constexpr LaneTable make_flagged_first() {
    LaneTable table;
    for (std::uint64_t flags = 0; flags <= kAllFlags; ++flags) {
        std::size_t before = 0;
        for (std::size_t j = 0; j < kLanes; ++j) {
            for (std::size_t part = 0; part < kParts; ++part) {
                if ((flags >> j & 1) != 0) {
                    table.rows[flags][kParts * before + part] =
                        static_cast<Index>(kParts * j + part);
                }
            }
            before += flags >> j & 1;
        }
    }
    return table;
}
/// Rows for flagged_first(), computed by the compiler.
constexpr LaneTable kFlaggedFirst = make_flagged_first();
/// Returns the flagged lanes in front, in order; the lanes after them are undefined.
inline Lanes flagged_first(Lanes values, std::uint64_t flags) {
    return ordered(values, row_of(kFlaggedFirst, flags));
}

#endif

/// Returns from[number of flags before lane j] in lane j.  Reads all of from[0 ... kLanes - 1].
inline Lanes step_at_flags(const double* from, Order order) {
    return ordered(load_lanes(from), order);
}
/// Writes the flagged lanes to to[0], to[1], ... in order.  May overwrite to[0 ... kLanes - 1];
/// elements after the flagged lanes are undefined.
inline void keep_flagged(double* to, Lanes values, std::uint64_t flags) {
    store_lanes(to, flagged_first(values, flags));
}

#else

/// Functions as above for two lanes.  The order is the source of lane 1: element 0 or 1.
typedef std::size_t Order;
inline Order behind(std::uint64_t flags) { return flags & 1; }
inline Lanes step_at_flags(const double* from, Order order) { return Lanes{from[0], from[order]}; }
inline void keep_flagged(double* to, Lanes values, std::uint64_t flags) {
    to[0] = values[0];
    to[flags & 1] = values[1];
}

#endif

}  // namespace
}  // namespace a351::corrector::eemd
