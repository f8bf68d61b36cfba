#pragma once
/// @file
/// Least squares as a textbook writes it, for comparison: a dense matrix, orthogonalised twice by
/// Gram and Schmidt in long double.  It shares no code with the adjustment.

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/support/catch.hpp"

namespace a351::test {

using Real = long double;
using Matrix = std::vector<std::vector<Real>>;  ///< Columns.

/// Solution of weighted rows a x = y.
struct DenseSolution {
    std::vector<Real> values;
    Matrix cofactor;      ///< (A' A)^-1
    Real condition = 1;   ///< Estimate: norms of R and of its inverse, columns of length 1.
};

inline Real dot(const std::vector<Real>& a, const std::vector<Real>& b) {
    Real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// @param a  columns, linearly independent.
inline DenseSolution solve_dense(Matrix a, const std::vector<Real>& y) {
    const std::size_t p = a.size();
    std::vector<Real> length(p);
    for (std::size_t k = 0; k < p; ++k) {
        length[k] = std::sqrt(dot(a[k], a[k]));
        for (Real& value : a[k]) value /= length[k];
    }
    Matrix q = a, r(p, std::vector<Real>(p));
    for (std::size_t k = 0; k < p; ++k) {
        for (int round = 0; round < 2; ++round)
            for (std::size_t j = 0; j < k; ++j) {
                const Real part = dot(q[j], q[k]);
                r[j][k] += part;
                for (std::size_t i = 0; i < y.size(); ++i) q[k][i] -= part * q[j][i];
            }
        r[k][k] = std::sqrt(dot(q[k], q[k]));
        for (Real& value : q[k]) value /= r[k][k];
    }
    // R^-1, upper triangular
    Matrix inverse(p, std::vector<Real>(p));
    for (std::size_t k = 0; k < p; ++k) {
        inverse[k][k] = 1 / r[k][k];
        for (std::size_t j = k; j-- > 0;) {
            Real sum = 0;
            for (std::size_t i = j + 1; i <= k; ++i) sum += r[j][i] * inverse[i][k];
            inverse[j][k] = -sum / r[j][j];
        }
    }
    DenseSolution solution{std::vector<Real>(p), Matrix(p, std::vector<Real>(p)), 1};
    Real of_r = 0, of_inverse = 0;
    for (std::size_t j = 0; j < p; ++j) {
        for (std::size_t k = 0; k < p; ++k) {
            of_r += r[j][k] * r[j][k];
            of_inverse += inverse[j][k] * inverse[j][k];
            solution.values[j] += inverse[j][k] * dot(q[k], y) / length[j];
            for (std::size_t i = 0; i < p; ++i)
                solution.cofactor[j][i] +=
                    inverse[j][k] * inverse[i][k] / (length[j] * length[i]);
        }
    }
    solution.condition = std::sqrt(of_r * of_inverse);
    return solution;
}

}  // namespace a351::test
