#pragma once
/// @file
/// Least-squares adjustment of gravities and terms, from one factorisation.
///
///     x = (A' W A)^-1 A' W y,   W = diag(1 / sd^2),   Q = (A' W A)^-1
///     v = A x - y               residuals
///     r_i = 1 - a_i' Q a_i / sd_i^2            redundancy of a row, their sum is the dof
///     s0^2 = v' W v / dof
///
/// A reading touches one station, so that the normal matrix of the stations is diagonal.  They are
/// eliminated first:
///
///     [ D   B ]        S = C - B' D^-1 B          dense, terms only; by Cholesky
///     [ B'  C ]
///
/// The columns are scaled to length 1.  Iterative refinement with the residuals of the rows gives the
/// accuracy of an orthogonal decomposition.
///
///     const Adjustment adjustment(equations);
///     if (!adjustment.undetermined().empty()) return;    // these unknowns depend on each other
///     adjustment.value(0);                               // gravity of station 0
///     std::sqrt(adjustment.variance({{0, 1.0}, {3, -1.0}}));   // u of a difference
///     adjustment.residual(5) / adjustment.redundancy(5);       // error of predicting row 5
///
/// Accuracy (adjustment_test.cpp): values, covariance and predictions of 500 random problems agree
/// with a QR decomposition in long double within max(1e-9, 100 eps x condition number).
///
/// Cost: the cube of the number of terms, and the square of the number of unknowns for Q.
///
/// Sources: H. Wolf, Ausgleichungsrechnung, Duemmler 1975 (elimination of the orientation
/// unknowns); W. Baarda, A testing procedure for use in geodetic networks, Delft 1968 (redundancy);
/// A. Bjorck, Linear Algebra Appl. 88/89, 31-48, 1987 (refinement of the normal equations).

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "corrector/adjustment/equations.hpp"
#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::adjustment {

/// A gradient or a solution: one number for each unknown.
struct Unknowns {
    Eigen::VectorXd stations, terms;
};

/// The normal equations of a system, factored.  It keeps no reference to the system.
class NormalEquations {
public:
    explicit NormalEquations(const Equations& equations);

    /// Returns the unknowns that the rows do not determine, in ascending order: those that take
    /// part in a combination that changes no row.
    [[nodiscard]] const std::vector<std::size_t>& undetermined() const { return undetermined_; }

    /// Returns N^-1 gradient.  Nothing is undetermined; not checked.
    [[nodiscard]] Unknowns solve(const Unknowns& gradient) const;

    /// Returns N^-1 (stations + terms, the same).
    [[nodiscard]] Eigen::MatrixXd inverse() const;

    /// Returns the least pivot of a column of length 1, 0 to 1.  Its inverse is about the square of the
    /// condition number.
    [[nodiscard]] double least_pivot() const { return least_pivot_; }

private:
    /// Finds combinations of unknowns that change no row.
    void find_undetermined(const Eigen::MatrixXd& reduced);
    /// Returns the least pivot of a term that is determined.
    [[nodiscard]] double least_pivot_of(Eigen::Index term) const;

    Eigen::VectorXd of_stations_;              ///< D.
    std::vector<std::vector<Entry>> of_both_;  ///< B, for each station its terms.
    Eigen::VectorXd scale_;                    ///< (terms) 1 / length of the columns.
    Eigen::VectorXd prior_weights_;            ///< (terms) 1 / sd^2 of their priors; 0 without one.
    std::optional<linear_algebra::Cholesky> factor_;  ///< S, scaled.
    double least_pivot_ = 1.0;
    std::vector<std::size_t> undetermined_;
};

/// Q is computed at once, or left out until compute_cofactor().
enum class Cofactor { computed, left_out };

/// An adjustment.  Constant members may be called from several threads at a time.
class Adjustment {
public:
    explicit Adjustment(Equations equations, Cofactor cofactor = Cofactor::computed);

    /// Computes Q, which redundancies, variances and what follows from them need; once.
    void compute_cofactor();

    [[nodiscard]] const Equations& equations() const { return equations_; }
    [[nodiscard]] const NormalEquations& normal() const { return normal_; }
    /// As NormalEquations::undetermined().  With any, the other members have no meaning.
    [[nodiscard]] const std::vector<std::size_t>& undetermined() const {
        return normal_.undetermined();
    }

    /// Returns the number of rows minus that of unknowns; 0 if there are fewer rows.
    [[nodiscard]] std::size_t dof() const;
    /// Returns v' W v.
    [[nodiscard]] double weighted_square() const { return weighted_square_; }
    /// Returns s0; absent if dof = 0.
    [[nodiscard]] std::optional<double> s0() const;

    /// Returns an unknown, in its unit.
    [[nodiscard]] double value(std::size_t unknown) const { return values_[unknown]; }
    /// Returns v of a row, in its unit.
    [[nodiscard]] double residual(std::size_t row) const { return residuals_[row]; }
    /// Returns the redundancy of a row: 0 uncontrolled, 1 fully controlled.
    [[nodiscard]] double redundancy(std::size_t row) const;
    /// Returns v / (sd s_i sqrt(r)) of a row, where s_i comes from the other rows.  Absent without a
    /// redundancy, if dof < 2, or if s_i is not positive.
    [[nodiscard]] std::optional<double> studentised(std::size_t row) const;

    /// Returns an element of Q.
    [[nodiscard]] double cofactor(std::size_t a, std::size_t b) const;
    /// Returns the covariance of two combinations.
    /// @param noise  ratio of the true standard deviation of the readings to the stated one.  References
    ///               and priors keep theirs: noise^2 (Q - Q P Q) + Q P' Q, with P their normal matrix,
    ///               and P' that of true_ratio^2 times their variances.
    [[nodiscard]] double covariance(const Combination& a, const Combination& b,
                                    double noise = 1.0) const;
    /// Returns the variance of a combination.
    [[nodiscard]] double variance(const Combination& combination, double noise = 1.0) const {
        return covariance(combination, combination, noise);
    }

private:
    Equations equations_;
    NormalEquations normal_;
    std::vector<double> values_, residuals_;
    double weighted_square_ = 0.0;
    bool has_true_ratio_ = false;  ///< A row has another standard deviation than the stated one.
    Eigen::MatrixXd cofactor_;     ///< Q.
};

/// Least redundancy of a row that v / r predicts without itself.  Reason: below it v / r is rounding.
inline constexpr double kLeastRedundancy = 1e-9;

/// Returns A' W y: the gradient of values, one for each row.
[[nodiscard]] Unknowns gradient_of(const Equations& equations, const Eigen::VectorXd& values);

/// Returns the factors of a row times the unknowns.
[[nodiscard]] double product(const Equations& equations, std::size_t row, const Unknowns& unknowns);

}  // namespace a351::corrector::adjustment
