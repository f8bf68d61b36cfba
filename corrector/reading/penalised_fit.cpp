#include "corrector/reading/penalised_fit.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace a351::corrector::reading {
namespace {

/// Largest relative error of a fitted straight line.  Reason: one refinement reduces it to its
/// square; the diagonal of the inverse has the error itself.
constexpr double kMostLineError = 0.01;

}  // namespace

double penalty_of(double cutoff_period) noexcept {
    const double difference = 2.0 * std::sin(std::numbers::pi / cutoff_period);
    const double square = difference * difference;
    return 1.0 / (square * square);
}

PenalisedFit::PenalisedFit(std::span<const double> weights, double penalty)
    : weights_(weights.begin(), weights.end()),
      penalty_(penalty),
      diagonal_(weights.begin(), weights.end()),
      below_(weights.size()),
      below2_(weights.size()) {
    const std::size_t n = weights.size();
    assert(n >= 3 && penalty > 0.0);
    // Each row (1, -2, 1) of D adds its outer product with itself.
    for (std::size_t i = 0; i + 2 < n; ++i) {
        diagonal_[i] += penalty;
        diagonal_[i + 1] += 4.0 * penalty;
        diagonal_[i + 2] += penalty;
        below_[i] -= 2.0 * penalty;
        below_[i + 1] -= 2.0 * penalty;
        below2_[i] += penalty;
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (i >= 2) diagonal_[i] -= diagonal_[i - 2] * below2_[i - 2] * below2_[i - 2];
        if (i >= 1) {
            diagonal_[i] -= diagonal_[i - 1] * below_[i - 1] * below_[i - 1];
            below_[i] -= diagonal_[i - 1] * below_[i - 1] * below2_[i - 1];
        }
        below_[i] /= diagonal_[i];
        below2_[i] /= diagonal_[i];
    }
    if (!returns_line()) {
        throw std::invalid_argument(
            "PenalisedFit: weights: too few, or too far apart, for this penalty");
    }
}

/// Returns true if the factors reproduce a straight line.  They should, because a line has no
/// second differences.  Across gaps much longer than the cut-off, rounding bends it.
bool PenalisedFit::returns_line() const {
    const std::size_t n = weights_.size();
    std::vector<double> line(n);
    for (std::size_t i = 0; i < n; ++i)
        line[i] = 1.0 + static_cast<double>(i) / static_cast<double>(n - 1);
    std::vector<double> right_side = line;
    for (std::size_t i = 0; i < n; ++i) right_side[i] *= weights_[i];
    const std::vector<double> fitted = substitute(std::move(right_side));
    for (std::size_t i = 0; i < n; ++i) {
        if (!(std::abs(fitted[i] - line[i]) <= kMostLineError)) return false;
    }
    return true;
}

std::vector<double> PenalisedFit::solve(std::span<const double> right_side) const {
    assert(right_side.size() == diagonal_.size());
    std::vector<double> x = substitute({right_side.begin(), right_side.end()});
    const std::vector<double> correction = substitute(remainder(right_side, x));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction[i];
    return x;
}

/// Returns x of L diag(d) L' x = right_side, which is given in `x`.
std::vector<double> PenalisedFit::substitute(std::vector<double> x) const {
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (i >= 1) x[i] -= below_[i - 1] * x[i - 1];
        if (i >= 2) x[i] -= below2_[i - 2] * x[i - 2];
    }
    for (std::size_t i = n; i-- > 0;) {
        x[i] /= diagonal_[i];
        if (i + 1 < n) x[i] -= below_[i] * x[i + 1];
        if (i + 2 < n) x[i] -= below2_[i] * x[i + 2];
    }
    return x;
}

/// Returns right_side - A x, computed from differences of x.  The products of A itself are of the
/// size of lambda x; the small remainder of a smooth x would be lost in them.
std::vector<double> PenalisedFit::remainder(std::span<const double> right_side,
                                            std::span<const double> x) const {
    std::vector<double> left(right_side.begin(), right_side.end());
    for (std::size_t i = 0; i < x.size(); ++i) left[i] -= weights_[i] * x[i];
    for (std::size_t i = 0; i + 2 < x.size(); ++i) {
        const double pull = penalty_ * ((x[i] - x[i + 1]) - (x[i + 1] - x[i + 2]));
        left[i] -= pull;
        left[i + 1] += 2.0 * pull;
        left[i + 2] -= pull;
    }
    return left;
}

std::vector<double> PenalisedFit::inverse_diagonal() const {
    const std::size_t n = diagonal_.size();
    std::vector<double> inverse(n);
    double next_off = 0.0;  // inverse[i + 1][i + 2]
    for (std::size_t i = n; i-- > 0;) {
        const double a = i + 1 < n ? below_[i] : 0.0;
        const double b = i + 2 < n ? below2_[i] : 0.0;
        const double next = i + 1 < n ? inverse[i + 1] : 0.0;
        const double after_next = i + 2 < n ? inverse[i + 2] : 0.0;
        const double off = -a * next - b * next_off;            // inverse[i][i + 1]
        const double far_off = -a * next_off - b * after_next;  // inverse[i][i + 2]
        inverse[i] = 1.0 / diagonal_[i] - a * off - b * far_off;
        next_off = off;
    }
    return inverse;
}

}  // namespace a351::corrector::reading
