#pragma once
/// @file
/// Cubic splines through the alternating knots of two envelopes, and the mean of the two.
///
/// Plain loops, compiled once for every instruction set (sift_kernels.hpp): all names are internal
/// to the file that includes this one, and nothing of the standard library's is instantiated.
/// Elements of a loop do not depend on each other, but for the elimination, which is written for
/// pairs of doubles; so every instruction set gives the same bits.
///
/// One envelope alone: knots (X_i, Y_i), h_i = X_{i+1} - X_i, s_i = (Y_{i+1} - Y_i) / h_i and
///
///     S(t) = Y_i + d (b_i + d (c_i + d e_i)),   d = t - X_i,
///     h_{i-1} c_{i-1} + 2 (h_{i-1} + h_i) c_i + h_i c_{i+1} = 3 (s_i - s_{i-1}).
///
/// In the list of both envelopes' knots the same neighbours are two apart.
/// Source: C. de Boor, A Practical Guide to Splines, Springer, 1978, chap. IV; c_i here is half the
/// second derivative.

#include <cstddef>

#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector {
namespace {

/// One row of each envelope.
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

inline Pair load(const double* from) { return *reinterpret_cast<const Pair*>(from); }
inline void store(double* to, Pair value) { *reinterpret_cast<Pair*>(to) = value; }

/// Distances and slopes, and the rows 2 ... n - 3 of the equations.
inline void set_up_rows(const double* x, const double* y, std::size_t n,
                        const SplineArrays& arrays) {
    double* const h = arrays.h;
    double* const inverse = arrays.inverse;
    double* const slope = arrays.slope;
    double* const diagonal = arrays.diagonal;
    double* const product = arrays.product;
    double* const right = arrays.right;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n - 2; ++k) {
        h[k] = x[k + 2] - x[k];
        inverse[k] = 1.0 / h[k];
        slope[k] = (y[k + 2] - y[k]) * inverse[k];
    }
#pragma GCC ivdep
    for (std::size_t k = 2; k < n - 2; ++k) {
        diagonal[k] = 2.0 * (h[k - 2] + h[k]);
        product[k] = h[k - 2] * h[k - 2];
        right[k] = 3.0 * (slope[k] - slope[k - 2]);
    }
}

/// Not-a-knot: the third derivative is continuous at the outermost rows.  The rows' inner
/// coefficient becomes inner - outer distance.
inline void set_not_a_knot_rows(std::size_t n, const SplineArrays& arrays) {
    const double* const h = arrays.h;
    const auto set = [&](std::size_t k, double outer, double inner) {
        arrays.diagonal[k] = outer + 2.0 * inner;
        arrays.right[k] *= inner / (inner + outer);
    };
    for (std::size_t k = 2; k <= 3; ++k) {
        set(k, h[k - 2], h[k]);
        arrays.product[k + 2] = h[k] * (h[k] - h[k - 2]);
    }
    for (std::size_t k = n - 4; k <= n - 3; ++k) {
        set(k, h[k], h[k - 2]);
        const double coupling = k - 2 <= 3 ? h[k - 2] - h[k - 4] : h[k - 2];
        arrays.product[k] = (h[k - 2] - h[k]) * coupling;
    }
}

/// One direction of the elimination from both ends to the middle, without a division in its chain.
///
///     p_k = diagonal_k p_{k-2} - product_k p_{k-4}
///     z_k = right_k p_{k-2} - coupling_k z_{k-2}        pivot of row k = p_k / p_{k-2}
///
/// with p_{k-2} brought to 1 now and then, lest it overflow.
struct Elimination {
    Pair before = {0.0, 0.0};   ///< p_{k-4}
    Pair latest = {1.0, 1.0};   ///< p_{k-2}
    Pair reduced = {0.0, 0.0};  ///< z_{k-2}

    void step(Pair diagonal, Pair product, Pair right, Pair coupling) {
        const Pair next = diagonal * latest - product * before;
        reduced = right * latest - coupling * reduced;
        before = latest;
        latest = next;
    }
    void rescale() {
        const Pair inverse = Pair{1.0, 1.0} / latest;
        before *= inverse;
        reduced *= inverse;
        latest = Pair{1.0, 1.0};
    }
};

/// Every step multiplies p by at most four times the longest distance, 32 bits for any record that
/// fits in memory: 16 steps and the three of the ends stay within a double's 1023.
constexpr std::size_t kStepsPerScale = 16;

/// Rows from both ends to the middle: pivot = p_k, former = p_{k-2}, c = z_k.  Rows before `middle`
/// depend on the row after them, the others on the row before.
inline void eliminate(std::size_t n, std::size_t middle, const SplineArrays& arrays) {
    const double* const h = arrays.h;
    const double* const diagonal = arrays.diagonal;
    const double* const product = arrays.product;
    const double* const right = arrays.right;
    double* const pivot = arrays.pivot;
    double* const former = arrays.former;
    double* const c = arrays.c;
    Elimination up;
    Elimination down;
    const auto step = [&](Elimination& at, std::size_t k, Pair product_k, Pair coupling) {
        at.step(load(diagonal + k), product_k, load(right + k), coupling);
        store(former + k, at.before);
        store(pivot + k, at.latest);
        store(c + k, at.reduced);
    };
    const Pair none = {0.0, 0.0};
    step(up, 2, none, none);
    step(down, n - 4, none, none);
    std::size_t i = 4;
    for (std::size_t k = n - 6; k >= middle;) {
        for (std::size_t count = 0; count < kStepsPerScale && k >= middle; ++count) {
            step(up, i, load(product + i), load(h + i - 2));
            step(down, k, load(product + k + 2), load(h + k));
            i += 2;
            k -= 2;
        }
        up.rescale();
        down.rescale();
    }
    if (i + 2 <= middle) {
        step(up, i, load(product + i), load(h + i - 2));
        i += 2;
    }
    if (i < middle) {
        former[i] = up.latest[0];
        pivot[i] = diagonal[i] * up.latest[0] - product[i] * up.before[0];
        c[i] = right[i] * up.latest[0] - h[i - 2] * up.reduced[0];
    }
}

/// Divides by the pivots: c_k + former_k c_{k+2} = c_k' before `middle`, c_{k-2} from there on.
inline void divide_by_pivots(std::size_t n, std::size_t middle, SplineEnds ends,
                             const SplineArrays& arrays) {
    const double* const h = arrays.h;
    const double* const pivot = arrays.pivot;
    double* const former = arrays.former;
    double* const c = arrays.c;
    const auto divide = [&](std::size_t k, double coupling) {
        const double inverse = 1.0 / pivot[k];
        c[k] *= inverse;
        former[k] *= coupling * inverse;
    };
    const bool not_a_knot = ends == SplineEnds::not_a_knot;
    for (std::size_t k = 2; k <= 3; ++k) divide(k, not_a_knot ? h[k] - h[k - 2] : h[k]);
#pragma GCC ivdep
    for (std::size_t k = 4; k < middle; ++k) divide(k, h[k]);
#pragma GCC ivdep
    for (std::size_t k = middle; k < n - 4; ++k) divide(k, h[k - 2]);
    for (std::size_t k = n - 4; k <= n - 3; ++k) divide(k, not_a_knot ? h[k - 2] - h[k] : h[k - 2]);
}

/// c of all rows, from the middle outwards.
inline void substitute(std::size_t n, std::size_t middle, const SplineArrays& arrays) {
    const double* const link = arrays.former;
    double* const c = arrays.c;
    Pair up = load(c + middle - 2);
    Pair down = load(c + middle);
    const Pair up_link = load(link + middle - 2);
    const Pair down_link = load(link + middle);
    up = (up - up_link * down) / (Pair{1.0, 1.0} - up_link * down_link);
    down = down - down_link * up;
    store(c + middle - 2, up);
    store(c + middle, down);
    std::size_t k = middle - 2;
    for (std::size_t i = middle + 2; i <= n - 4; i += 2) {
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
}

/// c of one envelope of two to four knots, every second from `first`.
inline void solve_few(const double* x, std::size_t first, std::size_t n, SplineEnds ends,
                      const SplineArrays& arrays) {
    const std::size_t knots = (n - first + 1) / 2;
    const std::size_t a = first;
    double* const c = arrays.c;
    const double* const h = arrays.h;
    const double* const slope = arrays.slope;
    for (std::size_t k = a; k < n; k += 2) c[k] = 0.0;
    if (knots == 2) return;
    const double bend = slope[a + 2] - slope[a];
    if (ends == SplineEnds::not_a_knot) {
        // The polynomial through all knots, by divided differences.
        const double second = bend / (x[a + 4] - x[a]);
        const double third =
            knots == 3 ? 0.0
                       : ((slope[a + 4] - slope[a + 2]) / (x[a + 6] - x[a + 2]) - second) /
                             (x[a + 6] - x[a]);
        for (std::size_t k = a; k < n; k += 2) {
            c[k] = second + third * ((x[k] - x[a]) + (x[k] - x[a + 2]) + (x[k] - x[a + 4]));
        }
        return;
    }
    const double d1 = 2.0 * (h[a] + h[a + 2]);
    if (knots == 3) {
        c[a + 2] = 3.0 * bend / d1;
        return;
    }
    const double d2 = 2.0 * (h[a + 2] + h[a + 4]);
    const double r1 = 3.0 * bend;
    const double r2 = 3.0 * (slope[a + 4] - slope[a + 2]);
    const double determinant = d1 * d2 - h[a + 2] * h[a + 2];
    c[a + 2] = (r1 * d2 - r2 * h[a + 2]) / determinant;
    c[a + 4] = (r2 * d1 - r1 * h[a + 2]) / determinant;
}

inline void solve(const double* x, const double* y, std::size_t n, SplineEnds ends,
                  const SplineArrays& arrays) {
    if (n < 8) {  // fewer than two rows from either end for both envelopes
        // Rounded once: a bow sifted off a monotone rest is symmetric, and the last bit decides
        // where its extremum is taken to be.
        for (std::size_t k = 0; k < n - 2; ++k) arrays.slope[k] = (y[k + 2] - y[k]) / arrays.h[k];
        solve_few(x, 0, n, ends, arrays);
        solve_few(x, 1, n, ends, arrays);
        return;
    }
    if (ends == SplineEnds::not_a_knot) set_not_a_knot_rows(n, arrays);
    const std::size_t right_rows = (n - 4) / 4 * 2;  // whole pairs, never more than the left ones
    const std::size_t middle = n - 2 - right_rows;
    eliminate(n, middle, arrays);
    divide_by_pivots(n, middle, ends, arrays);
    substitute(n, middle, arrays);
    double* const c = arrays.c;
    const double* const h = arrays.h;
    const double* const inverse = arrays.inverse;
    for (std::size_t k = 0; k <= 1; ++k) {
        const std::size_t m = n - 1 - k;
        const bool natural = ends == SplineEnds::natural;
        c[k] = natural ? 0.0 : c[k + 2] + h[k] * inverse[k + 2] * (c[k + 2] - c[k + 4]);
        c[m] = natural ? 0.0 : c[m - 2] + h[m - 2] * inverse[m - 4] * (c[m - 2] - c[m - 4]);
    }
}

/// Cubics of the mean of both envelopes: that of the envelope a knot belongs to, and that of the
/// other one expanded about the same position.
inline void average(const double* x, const double* y, std::size_t n, const SplineArrays& arrays) {
    const double* const h = arrays.h;
    const double* const inverse = arrays.inverse;
    const double* const slope = arrays.slope;
    const double* const c = arrays.c;
    double* const b = arrays.b;
    double* const e = arrays.e;
    constexpr double kThird = 1.0 / 3.0;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n - 2; ++k) {
        b[k] = slope[k] - kThird * h[k] * (c[k + 2] + 2.0 * c[k]);
        e[k] = kThird * inverse[k] * (c[k + 2] - c[k]);
    }
    double* const mean_y = arrays.mean_y;
    double* const mean_b = arrays.mean_b;
    double* const mean_c = arrays.mean_c;
    double* const mean_e = arrays.mean_e;
#pragma GCC ivdep
    for (std::size_t k = 1; k < n - 2; ++k) {
        const double d = x[k] - x[k - 1];
        const double other_e = e[k - 1];
        const double half = c[k - 1] + d * other_e;
        const double other_c = half + d * (2.0 * other_e);
        const double other_y = y[k - 1] + d * (b[k - 1] + d * half);
        const double other_b = b[k - 1] + d * (c[k - 1] + other_c);
        mean_y[k] = 0.5 * (y[k] + other_y);
        mean_b[k] = 0.5 * (b[k] + other_b);
        mean_c[k] = 0.5 * (c[k] + other_c);
        mean_e[k] = 0.5 * (e[k] + other_e);
    }
}

/// Fits both envelopes through `n` >= 4 alternating knots and leaves their mean in `arrays`.
inline void fit_mean_envelope(const double* x, const double* y, std::size_t n, SplineEnds ends,
                              const SplineArrays& arrays) {
    set_up_rows(x, y, n, arrays);
    solve(x, y, n, ends, arrays);
    average(x, y, n, arrays);
}

}  // namespace
}  // namespace a351::corrector
