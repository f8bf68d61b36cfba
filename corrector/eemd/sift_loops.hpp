#pragma once
/// @file
/// The search for extrema and the subtraction of the mean envelope, written once and compiled for
/// every instruction set.  The rules are in sift_kernels.hpp.
///
/// Comparisons of neighbours become bits, 64 samples to a word.  An extremum is a place where the
/// bits change from rise to fall or back.  It is found without a branch per sample.
///
/// The same bits say later at which samples the cubic changes.  Hence the subtraction needs no
/// search for the knot of a sample.
///
/// Call find_extrema() and subtract_mean_envelope() through SiftKernels; the other functions are
/// their parts.

#include <cstddef>
#include <cstdint>

#include "corrector/eemd/lanes.hpp"
#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector::eemd {
namespace {

/// Returns an index as a double, exact below 2^53.  The way over a signed integer is one
/// instruction on every processor.
inline double as_double(std::size_t index) {
    return static_cast<double>(static_cast<std::int64_t>(index));
}

/// Finds the extrema of curves with plateaus, sample by sample; otherwise as find_extrema().
///
/// A plateau is a run of equal samples.  Its position is its middle, which ends in 0.5 for an even
/// number of samples; the segment then starts at the next sample.
inline std::size_t find_plateaus(const double* curve, std::size_t n, double* positions,
                                 double* values, std::uint64_t* starts) {
    // Every step writes its candidate, and keeps it by increasing the count.  Branches here would
    // be the slowest part of a sift, because noise makes them unpredictable.
    std::size_t count = 0;
    bool was_rising = false;
    bool was_falling = false;
    std::size_t level_begin = 0;
    for (std::size_t i = 1; i < n; ++i) {
        const double before = curve[i - 1];
        const bool rises = curve[i] > before;
        const bool falls = curve[i] < before;
        positions[count] = 0.5 * as_double(level_begin + i - 1);
        values[count] = before;
        count += static_cast<std::size_t>((was_rising & falls) | (was_falling & rises));
        const bool moves = rises | falls;
        level_begin = moves ? i : level_begin;
        was_rising = moves ? rises : was_rising;
        was_falling = moves ? falls : was_falling;
    }
    for (std::size_t word = 0; word < n / 64 + 2; ++word) starts[word] = 0;
    for (std::size_t k = 0; k < count; ++k) {
        // Positions are multiples of 0.5, so truncating position + 0.5 rounds up.
        const double half_more = positions[k] + 0.5;
        const auto start = static_cast<std::size_t>(half_more);
        starts[start / 64] |= std::uint64_t{1} << (start % 64);
    }
    return count;
}

/// Returns the bits i = 0 ... count - 1 of curve[i + 1] > curve[i].  Makes `equals` different from
/// 0 if two neighbours are equal.
/// @param curve  count + 1 samples, finite.
/// @param count  1 to 64.
inline std::uint64_t rises_of(const double* curve, std::size_t count, Words& equals) {
    std::uint64_t rises = 0;
    std::size_t i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        const Lanes here = load_lanes(curve + i);
        const Lanes next = load_lanes(curve + i + 1);
        rises |= flags_of_greater(next, here) << i;
        equals |= reinterpret_cast<Words>(next == here);
    }
    for (; i < count; ++i) {
        rises |= std::uint64_t{curve[i + 1] > curve[i]} << i;
        equals[0] |= std::uint64_t{curve[i + 1] == curve[i]};
    }
    return rises;
}

/// Number of extrema in 64 samples above which all samples are moved by flags, not one by one.
/// Reason: one by one costs time per extremum, by flags time per sample.  The result is the same.
constexpr int kDense = 20;

/// Finds the interior extrema, see SiftKernels::find_extrema.  One pass over the curve; if two
/// neighbours are equal anywhere, a second pass by find_plateaus().
inline std::size_t find_extrema(const double* curve, std::size_t n, double* positions,
                                double* values, std::uint64_t* starts) {
    std::size_t count = 0;
    std::size_t word = 0;
    Words equals = {};
    std::uint64_t last_rise = n > 1 && curve[1] > curve[0] ? 1 : 0;
    const auto keep_first = [&](std::size_t begin, std::uint64_t turns, std::size_t to) {
        const std::size_t i = begin + static_cast<std::size_t>(__builtin_ctzll(turns));
        positions[to] = as_double(i);
        values[to] = curve[i];
    };
    for (; 64 * word + 64 < n; ++word) {
        const std::size_t begin = 64 * word;
        const double* const here = curve + begin;
        const std::uint64_t rises = rises_of(here, 64, equals);
        std::uint64_t turns = rises ^ (rises << 1 | last_rise);
        last_rise = rises >> 63;
        starts[word] = turns;
        const int found = __builtin_popcountll(turns);
        if (found > kDense) {
            Lanes position = counting_from(as_double(begin));
            for (std::size_t i = 0; i < 64; i += kLanes) {
                const std::uint64_t flags = turns >> i & kAllFlags;
                keep_flagged(positions + count, position, flags);
                keep_flagged(values + count, load_lanes(here + i), flags);
                count += count_flags(flags);
                position += static_cast<double>(kLanes);
            }
        } else {
            // Always four at a time, even if fewer are left: one branch less to be mispredicted.
            const std::size_t end = count + static_cast<std::size_t>(found);
            for (std::size_t to = count; to < end; to += 4) {
                for (std::size_t more = 0; more < 4; ++more) {
                    keep_first(begin, turns | std::uint64_t{1} << 63, to + more);
                    turns &= turns - 1;
                }
            }
            count = end;
        }
    }
    const std::size_t begin = 64 * word;
    if (begin + 1 < n) {
        const std::size_t pairs = n - 1 - begin;
        const std::uint64_t rises = rises_of(curve + begin, pairs, equals);
        std::uint64_t turns = rises ^ (rises << 1 | last_rise);
        turns &= (std::uint64_t{1} << pairs) - 1;
        starts[word++] = turns;
        for (; turns != 0; turns &= turns - 1) keep_first(begin, turns, count++);
    }
    if (any_of(equals) != 0) return find_plateaus(curve, n, positions, values, starts);
    for (; word < n / 64 + 2; ++word) starts[word] = 0;
    return count;
}

/// Cubics of some samples, and the distances d of the samples from the knots before them.
/// Lane j belongs to sample j of the group: y + d (b + d (c + d e)), with d in samples.
struct Cubics {
    Lanes d, y, b, c, e;
};

/// Computes out = curve - cubics, in two halves as average() in spline_loops.hpp.
inline void subtract_cubics(const double* curve, double* out, const Cubics& at) {
    const Lanes line = at.y + at.d * at.b;
    const Lanes bend = at.c + at.d * at.e;
    store_lanes(out, (load_lanes(curve) - line) - at.d * at.d * bend);
}

/// Computes out = curve - mean envelope, see SiftKernels::subtract_mean_envelope.  A word of 64
/// samples without an extremum is one cubic; other words take the cubic of every sample by its
/// flag.
inline void subtract_mean_envelope(const double* curve, double* out, std::size_t n,
                                   const std::uint64_t* starts, const double* x,
                                   std::size_t first_segment, const SplineArrays& arrays) {
    const double* const y = arrays.mean_y;
    const double* const b = arrays.mean_b;
    const double* const c = arrays.mean_c;
    const double* const e = arrays.mean_e;
    std::size_t k = first_segment;
    Lanes t = {};
    const auto next_cubics = [&](std::uint64_t flags) {
        const Order order = behind(flags);
        const auto of_lanes = [&](const double* from) { return step_at_flags(from + k, order); };
        const Cubics cubics = {t - of_lanes(x), of_lanes(y), of_lanes(b), of_lanes(c), of_lanes(e)};
        k += count_flags(flags);
        t += static_cast<double>(kLanes);
        return cubics;
    };
    for (std::size_t word = 0; 64 * word < n; ++word) {
        // Bit i is set if a segment begins at the sample after i.
        std::uint64_t bits = starts[word] >> 1 | starts[word + 1] << 63;
        const std::size_t begin = 64 * word;
        const std::size_t end = n - begin < 64 ? n : begin + 64;
        t = counting_from(as_double(begin));
        if (bits == 0) {
            Cubics cubics = {t - x[k], all_lanes(y[k]), all_lanes(b[k]), all_lanes(c[k]),
                             all_lanes(e[k])};
            for (std::size_t i = begin; i < end; i += kLanes) {
                subtract_cubics(curve + i, out + i, cubics);
                cubics.d += static_cast<double>(kLanes);
            }
            continue;
        }
        // The cubics are read one step before they are used.  Otherwise waiting arithmetic would
        // fill the processor's queue.
        Cubics cubics = next_cubics(bits & kAllFlags);
        std::size_t i = begin;
        for (; i + kLanes < end; i += kLanes) {
            bits >>= kLanes;
            const Cubics next = next_cubics(bits & kAllFlags);
            subtract_cubics(curve + i, out + i, cubics);
            cubics = next;
        }
        subtract_cubics(curve + i, out + i, cubics);
    }
}

}  // namespace
}  // namespace a351::corrector::eemd
