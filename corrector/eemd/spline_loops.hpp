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
/// average() reads and writes whole groups of lanes, up to kLanes - 1 elements too far.
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
/// - average(): the mean cubic of each knot.
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

#ifdef __AVX__

/// A pair of rows from the left (elements 0 and 1) and one from the right (elements 2 and 3).  With
/// all four in one register the elimination takes 3.4 cycles per knot, with two registers 4.8
/// (Zen 4).
typedef double TwoPairs __attribute__((vector_size(32)));
inline TwoPairs two_pairs(Pair left, Pair right) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(left), right, 1);
}
inline Pair left_of(TwoPairs both) { return _mm256_castpd256_pd128(both); }
inline Pair right_of(TwoPairs both) { return _mm256_extractf128_pd(both, 1); }
/// Returns the left of `a` and the right of `b`.
inline TwoPairs left_and_right(TwoPairs a, TwoPairs b) { return _mm256_blend_pd(a, b, 0b1100); }

#else

/// The same for registers of two doubles.
struct TwoPairs {
    Pair left, right;
};
inline TwoPairs two_pairs(Pair left, Pair right) { return {left, right}; }
inline Pair left_of(TwoPairs both) { return both.left; }
inline Pair right_of(TwoPairs both) { return both.right; }
inline TwoPairs left_and_right(TwoPairs a, TwoPairs b) { return {a.left, b.right}; }
inline TwoPairs operator+(TwoPairs a, TwoPairs b) { return {a.left + b.left, a.right + b.right}; }
inline TwoPairs operator-(TwoPairs a, TwoPairs b) { return {a.left - b.left, a.right - b.right}; }
inline TwoPairs operator*(TwoPairs a, TwoPairs b) { return {a.left * b.left, a.right * b.right}; }
inline TwoPairs operator*(double a, TwoPairs b) { return {a * b.left, a * b.right}; }
inline TwoPairs operator/(TwoPairs a, TwoPairs b) { return {a.left / b.left, a.right / b.right}; }
inline TwoPairs operator/(double a, TwoPairs b) { return {a / b.left, a / b.right}; }

#endif

/// Returns a pair of array elements from the left and one from the right.
inline TwoPairs load(const double* left, const double* right) {
    return two_pairs(load(left), load(right));
}
/// Writes a pair of array elements at the left and one at the right.
inline void store(double* left, double* right, TwoPairs both) {
    store(left, left_of(both));
    store(right, right_of(both));
}

/// Distances and slopes from knots i, i + 1, k and k + 1 to the next knots of their envelopes.
struct Intervals {
    TwoPairs h;
    TwoPairs slope;

    /// Computes them, and stores 1 / h and the slope.
    Intervals(const double* x, const double* y, std::size_t i, std::size_t k, SplineArrays arrays)
        : h(load(x + i + 2, x + k + 2) - load(x + i, x + k)) {
        const TwoPairs inverse = 1.0 / h;
        slope = (load(y + i + 2, y + k + 2) - load(y + i, y + k)) * inverse;
        store(arrays.inverse + i, arrays.inverse + k, inverse);
        store(arrays.slope + i, arrays.slope + k, slope);
    }
};

/// Elimination from both ends to the middle, for both envelopes at once: four independent chains.
///
///     p_k = diagonal_k p_{k-2} - product_k p_{k-4}
///     z_k = right_k p_{k-2} - coupling_k z_{k-2}        pivot of row k: p_k / p_{k-2}
///
/// product_k is the product of the two coefficients between rows k and k - 2.  No chain contains a
/// division, so the processor divides one row while it eliminates the next.  p_{k-2} is scaled to 1
/// after every block, so that it does not overflow.
///
/// The constructor eliminates the outermost rows.  Call step() for each following row, and
/// rescale() once per block (kBlock).
class Elimination {
public:
    /// Eliminates the outermost rows, where the third derivative is continuous.
    /// @param end, next  outermost intervals, and the next ones towards the middle.
    Elimination(const Intervals& end, const Intervals& next)
        : before_(ones()),
          latest_(end.h + 2.0 * next.h),
          reduced_(right_side(end, next) * (next.h / (end.h + next.h))),
          coupling_(next.h - end.h),
          near_(next) {}
    /// Eliminates one row from either end.
    /// @param far  intervals from the row towards the middle.
    void step(const Intervals& far) {
        const TwoPairs next = 2.0 * (near_.h + far.h) * latest_ - near_.h * coupling_ * before_;
        reduced_ = right_side(near_, far) * latest_ - near_.h * reduced_;
        before_ = latest_;
        latest_ = next;
        coupling_ = far.h;
        near_ = far;
    }
    /// Divides p_k, p_{k-2} and z_k by p_k.  The equations of later rows do not change, except for
    /// rounding.
    void rescale() {
        const TwoPairs inverse = 1.0 / latest_;
        before_ = before_ * inverse;
        reduced_ = reduced_ * inverse;
        latest_ = ones();
    }
    /// Equations c_k + link_k c_j = r_k of the latest rows, where j is the next row towards the
    /// middle.
    [[nodiscard]] TwoPairs link() const { return coupling_ * before_ * (1.0 / latest_); }
    [[nodiscard]] TwoPairs right() const { return reduced_ * (1.0 / latest_); }

private:
    static TwoPairs ones() { return two_pairs(Pair{1.0, 1.0}, Pair{1.0, 1.0}); }

    /// Returns 3 (s_i - s_{i-1}) of the row between two intervals.
    static TwoPairs right_side(const Intervals& near, const Intervals& far) {
        return 3.0 *
               (left_and_right(far.slope, near.slope) - left_and_right(near.slope, far.slope));
    }

    TwoPairs before_;    ///< p_{k-4}
    TwoPairs latest_;    ///< p_{k-2}
    TwoPairs reduced_;   ///< z_{k-2}
    TwoPairs coupling_;  ///< coefficient from the row before to this one
    Intervals near_;     ///< intervals from the row before to this one
};

/// Pairs of rows per block, after which the elimination is rescaled.
///
/// The products of one block do not exceed a double's 1023 binary places.  Every step multiplies p
/// by less than 2 (near + far).  The distances of one block add up to less than the record's length
/// n, so the product is below (n / 8)^32.
constexpr std::size_t kBlock = 32;

/// Eliminates the rows before `middle` from the left and the others from the right.
///
/// Row k is the equation at knot k, 2 <= k <= n - 3.  Afterwards the arrays link and c have the
/// equations of Elimination for all rows, and the arrays inverse and slope are set.
///
/// @param n  number of knots, >= 8.
/// @param middle  first row from the right.  The right has whole pairs of rows, at most as many as
///                the left.
inline void eliminate(const double* x, const double* y, std::size_t n, std::size_t middle,
                      SplineArrays arrays) {
    const Intervals end(x, y, 0, n - 4, arrays);
    Elimination rows(end, Intervals(x, y, 2, n - 6, arrays));
    const auto keep_right = [&](std::size_t k) {
        store(arrays.link + k, right_of(rows.link()));
        store(arrays.c + k, right_of(rows.right()));
    };
    const auto keep_left = [&](std::size_t i) {
        store(arrays.link + i, left_of(rows.link()));
        store(arrays.c + i, left_of(rows.right()));
    };
    keep_left(2);
    keep_right(n - 4);
    std::size_t i = 4;
    std::size_t k = n - 6;
    // Intervals are computed one step before they are used.  Otherwise rows that wait for a division
    // would fill the processor's queue, and a knot would take 3.4 cycles instead of 3.1 (Zen 4).
    Intervals far(x, y, i, k - 2, arrays);
    while (k >= middle) {
        for (std::size_t step = 0; step < kBlock && k >= middle; ++step, i += 2, k -= 2) {
            const Intervals next(x, y, i + 2, k - 4, arrays);
            rows.step(far);
            far = next;
            keep_left(i);
            keep_right(k);
        }
        rows.rescale();
    }
    // Up to three rows are left at the left.  The last may be one of a pair whose other row is the
    // first from the right.  What a step computes for the right is not used.
    const double link = arrays.link[middle];
    const double c = arrays.c[middle];
    for (; i < middle; i += 2) {
        rows.step(Intervals(x, y, i, i, arrays));
        keep_left(i);
    }
    arrays.link[middle] = link;
    arrays.c[middle] = c;
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

/// Computes the cubics of the mean of both envelopes.  Each is half the sum of the cubic of the
/// knot's own envelope and of the other envelope's, expanded about the same position.
/// Reads c, inverse and slope; sets mean_y, mean_b, mean_c and mean_e.
///
/// Cubics are evaluated in two halves, here and at the samples.  In one chain by Horner's rule the
/// processor would wait, because it does not look far enough ahead for other work.
inline void average(const double* x, const double* y, std::size_t n, SplineArrays arrays) {
    constexpr double kThird = 1.0 / 3.0;
    const auto at = [](const double* array, std::size_t k) { return load_lanes(array + k); };
    Lanes x_before = {}, y_before = {}, b_before = {}, c_before = {}, e_before = {};
    for (std::size_t k = 0; k + 2 < n; k += kLanes) {
        const Lanes own_x = at(x, k);
        const Lanes own_y = at(y, k);
        const Lanes own_c = at(arrays.c, k);
        const Lanes next_c = at(arrays.c, k + 2);
        const Lanes h = at(x, k + 2) - own_x;
        const Lanes own_b = at(arrays.slope, k) - kThird * h * (next_c + 2.0 * own_c);
        const Lanes own_e = kThird * at(arrays.inverse, k) * (next_c - own_c);
        // The other envelope's cubic is that of the knot before.
        const Lanes d = own_x - last_and_front(x_before, own_x);
        const Lanes y_other = last_and_front(y_before, own_y);
        const Lanes b = last_and_front(b_before, own_b);
        const Lanes c = last_and_front(c_before, own_c);
        const Lanes e = last_and_front(e_before, own_e);
        x_before = own_x;
        y_before = own_y;
        b_before = own_b;
        c_before = own_c;
        e_before = own_e;
        const Lanes bend = d * e;
        const Lanes half = c + bend;
        const Lanes other_c = half + 2.0 * bend;
        const Lanes other_b = b + d * (c + other_c);
        const Lanes other_y = (y_other + d * b) + d * d * half;
        store_lanes(arrays.mean_y + k, 0.5 * (own_y + other_y));
        store_lanes(arrays.mean_b + k, 0.5 * (own_b + other_b));
        store_lanes(arrays.mean_c + k, 0.5 * (own_c + other_c));
        store_lanes(arrays.mean_e + k, 0.5 * (own_e + e));
    }
}

/// Computes c of all knots from the middle outwards.
///
/// The two rows of each envelope next to the middle are solved as a system of two equations.  The
/// outermost knots have no row; their c continues the line through the next two, which is the
/// not-a-knot condition.
///
/// @param n, middle  as eliminate().
inline void substitute(const double* x, std::size_t n, std::size_t middle, SplineArrays arrays) {
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
    for (; i <= n - 4; i += 2) {
        k -= 2;
        up = load(c + k) - load(link + k) * up;
        down = load(c + i) - load(link + i) * down;
        store(c + k, up);
        store(c + i, down);
    }
    if (k >= 4) {
        k -= 2;
        up = load(c + k) - load(link + k) * up;
        store(c + k, up);
    }
    if (k == 3) c[2] -= link[2] * up[1];
    const double* const inverse = arrays.inverse;
    for (std::size_t j = 0; j <= 1; ++j) {
        const std::size_t m = n - 1 - j;
        c[j] = c[j + 2] + (x[j + 2] - x[j]) * inverse[j + 2] * (c[j + 2] - c[j + 4]);
        c[m] = c[m - 2] + (x[m] - x[m - 2]) * inverse[m - 4] * (c[m - 2] - c[m - 4]);
    }
}

/// Fits both envelopes through `n` >= 4 alternating knots and leaves their mean in `arrays`.
/// The conditions are those of SiftKernels::fit_mean_envelope.  The time is O(n).
inline void fit_mean_envelope(const double* x, const double* y, std::size_t n,
                              const SplineArrays& shared) {
    // A local copy, so that no store below can change a pointer.
    const SplineArrays arrays = shared;
    if (n < 8) {  // both envelopes have fewer than two rows from either end
        // Division, which rounds once.  A bow sifted off a monotone rest is symmetric, and the last
        // bit decides the position of its extremum.
        for (std::size_t k = 0; k < n - 2; ++k) {
            const double h = x[k + 2] - x[k];
            arrays.inverse[k] = 1.0 / h;
            arrays.slope[k] = (y[k + 2] - y[k]) / h;
        }
        solve_few(x, 0, n, arrays);
        solve_few(x, 1, n, arrays);
        average(x, y, n, arrays);
        return;
    }
    const std::size_t right_rows = (n - 4) / 4 * 2;  // whole pairs, at most as many as on the left
    const std::size_t middle = n - 2 - right_rows;
    eliminate(x, y, n, middle, arrays);
    substitute(x, n, middle, arrays);
    average(x, y, n, arrays);
}

}  // namespace
}  // namespace a351::corrector::eemd
