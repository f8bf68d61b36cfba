#pragma once
/// @file
/// Cubic splines through the alternating knots of two envelopes, and the mean of the two.
///
/// Compiled once for every instruction set (sift_kernels.hpp).  All names are internal to the
/// including file, and nothing of the standard library is instantiated.
///
/// Elements of a loop do not depend on each other, except in the elimination, which is written for
/// pairs of doubles.  So every instruction set gives the same bits.
///
/// The loops write whole groups of lanes, up to kLanes - 1 elements too far.  These elements are
/// written again later, or receive the value that they already have: no loop changes its own input.
///
/// For one envelope with knots (X_i, Y_i), h_i = X_{i+1} - X_i, s_i = (Y_{i+1} - Y_i) / h_i:
///
///     S(t) = Y_i + d (b_i + d (c_i + d e_i)),   d = t - X_i,
///     h_{i-1} c_{i-1} + 2 (h_{i-1} + h_i) c_i + h_i c_{i+1} = 3 (s_i - s_{i-1}).
///
/// In the list of both envelopes' knots the neighbours i and i + 1 are two apart.
/// Source: C. de Boor, A Practical Guide to Splines, Springer, 1978, chap. IV; c_i here is half the
/// second derivative.
///
/// Call fit_mean_envelope() through SiftKernels; the other functions are its parts.  Steps for
/// eight knots or more:
///
/// - eliminate(): the equations for c, from both ends to the middle, for both envelopes at once;
/// - substitute(): c from the middle outwards;
/// - average(): the mean cubic of each knot as soon as c is known around it.
///
/// With fewer knots solve_few() computes c directly.  Accuracy: within 1e-9 of dense solutions,
/// also for thousands of knots (mean_envelope_test.cpp).

#include <cstddef>

#include "corrector/eemd/lanes.hpp"
#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector::eemd {
namespace {

/// One row of each of the two envelopes.
/// Element 0 is row k and element 1 is row k + 1, which belongs to the other envelope.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

/// Returns from[0] and from[1]; any address of a double will do.
inline Pair load(const double* from) { return *reinterpret_cast<const Pair*>(from); }
/// Writes to[0] and to[1]; any address of a double will do.
inline void store(double* to, Pair value) { *reinterpret_cast<Pair*>(to) = value; }

/// Computes distances and slopes from knot k to k + 2 for first <= k < last, and some beyond.
///
/// Sets arrays.h, inverse and slope.  Reads x and y up to kLanes + 1 elements after knot last - 1;
/// results beyond last are computed again later, or not used.
inline void set_up(const double* x, const double* y, std::size_t first, std::size_t last,
                   SplineArrays arrays) {
    for (std::size_t k = first; k < last; k += kLanes) {
        const Lanes h = load_lanes(x + k + 2) - load_lanes(x + k);
        const Lanes inverse = 1.0 / h;
        store_lanes(arrays.h + k, h);
        store_lanes(arrays.inverse + k, inverse);
        store_lanes(arrays.slope + k, (load_lanes(y + k + 2) - load_lanes(y + k)) * inverse);
    }
}

/// Elimination in one of the two directions, from an end to the middle, for both envelopes.
///
///     p_k = diagonal_k p_{k-2} - product_k p_{k-4}
///     z_k = right_k p_{k-2} - coupling_k z_{k-2}        pivot of row k: p_k / p_{k-2}
///
/// product_k is the product of the two coefficients between rows k and k - 2.  This recurrence
/// needs no division.  p_{k-2} is scaled to 1 after every block, so that it does not overflow.
///
/// A default-constructed object is before the first row.  Call first_step(), then step() for each
/// following row, and keep() after each.  Call rescale() once per block (kBlock).  Rows of both
/// envelopes are eliminated side by side.
struct Elimination {
    Pair before = {0.0, 0.0};    ///< p_{k-4}
    Pair latest = {1.0, 1.0};    ///< p_{k-2}
    Pair reduced = {0.0, 0.0};   ///< z_{k-2}
    Pair coupling = {0.0, 0.0};  ///< from the row before to this one

    /// Eliminates the outermost row, where the third derivative is continuous.
    /// @param near, far  distances to the outermost knot, and to the next one towards the middle.
    /// @param right      right side of the row's equation, 3 (s_i - s_{i-1}).
    void first_step(Pair near, Pair far, Pair right) {
        before = latest;
        latest = near + 2.0 * far;
        reduced = right * (far / (near + far));
        coupling = far - near;
    }
    /// Eliminates one row.
    /// @param near, far  distances to the next knot towards the end, and towards the middle.
    /// @param right      right side of the row's equation, 3 (s_i - s_{i-1}).
    void step(Pair near, Pair far, Pair right) {
        const Pair next = 2.0 * (near + far) * latest - near * coupling * before;
        reduced = right * latest - near * reduced;
        before = latest;
        latest = next;
        coupling = far;
    }
    /// Divides p_k, p_{k-2} and z_k by p_k.  The ratios that keep() stores later do not change,
    /// except for rounding.
    void rescale() {
        const Pair inverse = 1.0 / latest;
        before *= inverse;
        reduced *= inverse;
        latest = Pair{1.0, 1.0};
    }
    /// Stores the input of divide_by_pivots() in b and e; average() overwrites them later.
    void keep(std::size_t k, SplineArrays arrays) const {
        store(arrays.pivot + k, latest);
        store(arrays.e + k, coupling * before);
        store(arrays.b + k, reduced);
    }
};

/// Divides rows first <= k < last, and some beyond, by their pivots.  Then the array c holds the
/// right sides r_k of c_k + link_k c_j = r_k, where j is the next row towards the middle.
/// Needs keep() of all these rows.  This is the only division per row, done for whole vectors.
inline void divide_by_pivots(std::size_t first, std::size_t last, SplineArrays arrays) {
    for (std::size_t k = first; k < last; k += kLanes) {
        const Lanes inverse = 1.0 / load_lanes(arrays.pivot + k);
        store_lanes(arrays.link + k, load_lanes(arrays.e + k) * inverse);
        store_lanes(arrays.c + k, load_lanes(arrays.b + k) * inverse);
    }
}

/// Pairs of rows per block.  A block is set up, eliminated and divided before the next one, so that
/// it stays in the first-level cache.
///
/// The products of one block do not exceed a double's 1023 binary places.  Every step multiplies p
/// by less than 2 (near + far).  The distances of one block add up to less than the record's length
/// n, so the product is below (n / 8)^32.
constexpr std::size_t kBlock = 32;

/// Eliminates the rows before `middle` from the left and the others from the right.
///
/// Row k is the equation at knot k, 2 <= k <= n - 3.  Afterwards the arrays link and c have the
/// equations of divide_by_pivots() for all rows.
///
/// @param n  number of knots, >= 8.
/// @param middle  first row from the right.  The right has whole pairs of rows, at most as many as
///                the left.
inline void eliminate(const double* x, const double* y, std::size_t n, std::size_t middle,
                      SplineArrays arrays) {
    const double* const h = arrays.h;
    const double* const slope = arrays.slope;
    Elimination up;
    Elimination down;
    std::size_t up_ready = 4;
    std::size_t down_ready = n - 6;
    set_up(x, y, 0, up_ready, arrays);
    set_up(x, y, down_ready, n - 2, arrays);
    const auto right = [&](std::size_t k) { return 3.0 * (load(slope + k) - load(slope + k - 2)); };
    up.first_step(load(h), load(h + 2), right(2));
    up.keep(2, arrays);
    down.first_step(load(h + n - 4), load(h + n - 6), right(n - 4));
    down.keep(n - 4, arrays);
    std::size_t i = 4;
    std::size_t k = n - 6;
    std::size_t up_divided = 2;
    std::size_t down_divided = n - 2;
    while (k >= middle) {
        const std::size_t steps = (k - middle) / 2 + 1 < kBlock ? (k - middle) / 2 + 1 : kBlock;
        set_up(x, y, up_ready, i + 2 * steps, arrays);
        up_ready = i + 2 * steps;
        set_up(x, y, k - 2 * steps, down_ready, arrays);
        down_ready = k - 2 * steps;
        for (std::size_t step = 0; step < steps; ++step, i += 2, k -= 2) {
            up.step(load(h + i - 2), load(h + i), right(i));
            up.keep(i, arrays);
            down.step(load(h + k), load(h + k - 2), right(k));
            down.keep(k, arrays);
        }
        divide_by_pivots(up_divided, i, arrays);
        up_divided = i;
        divide_by_pivots(k + 2, down_divided, arrays);
        down_divided = k + 2;
        up.rescale();
        down.rescale();
    }
    set_up(x, y, up_ready, middle, arrays);
    if (i + 2 <= middle) {
        up.step(load(h + i - 2), load(h + i), right(i));
        up.keep(i, arrays);
        i += 2;
    }
    if (i < middle) {
        // One row of one envelope is left.  The other row of the pair is the first from the right.
        const double pivot = arrays.pivot[middle];
        const double coupled = arrays.e[middle];
        const double reduced = arrays.b[middle];
        up.step(load(h + i - 2), load(h + i), right(i));
        up.keep(i, arrays);
        arrays.pivot[middle] = pivot;
        arrays.e[middle] = coupled;
        arrays.b[middle] = reduced;
    }
    divide_by_pivots(up_divided, middle, arrays);
    divide_by_pivots(middle, down_divided, arrays);
}

/// Computes c of one envelope of two to four knots, every second one from `a`.  The envelope is the
/// polynomial through all knots, by divided differences.
///
/// Needs slope of the envelope's knots.  Sets c at these knots only; two knots give a line with c =
/// 0.
inline void solve_few(const double* x, std::size_t a, std::size_t n, SplineArrays arrays) {
    const std::size_t knots = (n - a + 1) / 2;
    double* const c = arrays.c;
    const double* const slope = arrays.slope;
    for (std::size_t k = a; k < n; k += 2) c[k] = 0.0;
    if (knots == 2) return;
    const double second = (slope[a + 2] - slope[a]) / (x[a + 4] - x[a]);
    const double third =
        knots == 3
            ? 0.0
            : ((slope[a + 4] - slope[a + 2]) / (x[a + 6] - x[a + 2]) - second) / (x[a + 6] - x[a]);
    for (std::size_t k = a; k < n; k += 2)
        c[k] = second + third * ((x[k] - x[a]) + (x[k] - x[a + 2]) + (x[k] - x[a + 4]));
}

/// Computes the cubics first <= k < last of the mean of both envelopes.  Each is half the sum of
/// the cubic of the knot's own envelope and of the other envelope's, expanded about the same
/// position.  Needs c from first - 1 to last + 1.
/// Reads h, inverse and slope too.  Overwrites b and e; sets mean_y, mean_b, mean_c and mean_e.
///
/// Cubics are evaluated in two halves, here and at the samples.  In one chain by Horner's rule the
/// processor would wait, because it does not look far enough ahead for other work.
inline void average(const double* x, const double* y, std::size_t first, std::size_t last,
                    SplineArrays arrays) {
    constexpr double kThird = 1.0 / 3.0;
    const auto at = [](const double* array, std::size_t k) { return load_lanes(array + k); };
    for (std::size_t k = first - 1; k < last; k += kLanes) {
        const Lanes c = at(arrays.c, k);
        const Lanes next_c = at(arrays.c, k + 2);
        store_lanes(arrays.b + k,
                    at(arrays.slope, k) - kThird * at(arrays.h, k) * (next_c + 2.0 * c));
        store_lanes(arrays.e + k, kThird * at(arrays.inverse, k) * (next_c - c));
    }
    for (std::size_t k = first; k < last; k += kLanes) {
        const Lanes d = at(x, k) - at(x, k - 1);
        const Lanes c = at(arrays.c, k - 1);
        const Lanes b = at(arrays.b, k - 1);
        const Lanes e = at(arrays.e, k - 1);
        const Lanes bend = d * e;
        const Lanes half = c + bend;
        const Lanes other_c = half + 2.0 * bend;
        const Lanes other_b = b + d * (c + other_c);
        const Lanes other_y = (at(y, k - 1) + d * b) + d * d * half;
        store_lanes(arrays.mean_y + k, 0.5 * (at(y, k) + other_y));
        store_lanes(arrays.mean_b + k, 0.5 * (at(arrays.b, k) + other_b));
        store_lanes(arrays.mean_c + k, 0.5 * (at(arrays.c, k) + other_c));
        store_lanes(arrays.mean_e + k, 0.5 * (at(arrays.e, k) + e));
    }
}

/// Computes c of all rows from the middle outwards, and the mean cubics as soon as c is known.
///
/// The two rows of each envelope next to the middle are solved as a system of two equations.  The
/// outermost knots have no row; their c continues the line through the next two, which is the
/// not-a-knot condition.
///
/// @param n, middle  as eliminate().
inline void substitute(const double* x, const double* y, std::size_t n, std::size_t middle,
                       SplineArrays arrays) {
    const double* const link = arrays.link;
    double* const c = arrays.c;
    Pair up = load(c + middle - 2);
    Pair down = load(c + middle);
    const Pair up_link = load(link + middle - 2);
    const Pair down_link = load(link + middle);
    up = (up - up_link * down) / (1.0 - up_link * down_link);
    down = down - down_link * up;
    store(c + middle - 2, up);
    store(c + middle, down);
    std::size_t k = middle - 2;  // first row known
    std::size_t i = middle + 2;  // first row after them
    std::size_t begin = middle - 1;
    std::size_t end = middle - 1;
    const auto average_known = [&](std::size_t first, std::size_t last) {
        average(x, y, first, begin, arrays);
        average(x, y, end, last, arrays);
        begin = first;
        end = last;
    };
    while (i <= n - 4) {
        for (std::size_t step = 0; step < kBlock && i <= n - 4; ++step, i += 2) {
            k -= 2;
            up = load(c + k) - load(link + k) * up;
            down = load(c + i) - load(link + i) * down;
            store(c + k, up);
            store(c + i, down);
        }
        average_known(k + 1, i - 2);
    }
    if (k >= 4) {
        k -= 2;
        up = load(c + k) - load(link + k) * up;
        store(c + k, up);
    }
    if (k == 3) c[2] -= link[2] * up[1];
    const double* const h = arrays.h;
    const double* const inverse = arrays.inverse;
    for (std::size_t j = 0; j <= 1; ++j) {
        const std::size_t m = n - 1 - j;
        c[j] = c[j + 2] + h[j] * inverse[j + 2] * (c[j + 2] - c[j + 4]);
        c[m] = c[m - 2] + h[m - 2] * inverse[m - 4] * (c[m - 2] - c[m - 4]);
    }
    average_known(1, n - 2);
}

/// Fits both envelopes through `n` >= 4 alternating knots and leaves their mean in `arrays`.
/// The conditions are those of SiftKernels::fit_mean_envelope.  The time is O(n).
inline void fit_mean_envelope(const double* x, const double* y, std::size_t n,
                              const SplineArrays& shared) {
    // A local copy, so that no store below can change a pointer.
    const SplineArrays arrays = shared;
    if (n < 8) {  // both envelopes have fewer than two rows from either end
        set_up(x, y, 0, n - 2, arrays);
        // Division, which rounds once.  A bow sifted off a monotone rest is symmetric, and the last
        // bit decides the position of its extremum.
        for (std::size_t k = 0; k < n - 2; ++k) arrays.slope[k] = (y[k + 2] - y[k]) / arrays.h[k];
        solve_few(x, 0, n, arrays);
        solve_few(x, 1, n, arrays);
        average(x, y, 1, n - 2, arrays);
        return;
    }
    const std::size_t right_rows = (n - 4) / 4 * 2;  // whole pairs, at most as many as on the left
    const std::size_t middle = n - 2 - right_rows;
    eliminate(x, y, n, middle, arrays);
    substitute(x, y, n, middle, arrays);
}

}  // namespace
}  // namespace a351::corrector::eemd
