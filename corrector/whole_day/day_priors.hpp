#pragma once
/// @file
/// Priors of the whole-day model on its lags and terms.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace a351::corrector {

/// Terms of the whole-day model (day_model.hpp): c, rA, rS, rF, d, w, bx, by.
enum class DayTerm { constant, level, slow, fast, drift, warm_up, x, y };
/// Number of terms.
inline constexpr std::size_t kDayTerms = 8;

/// Number of lags: fast tF, slow tS.  In DayPriors they are before the terms.
inline constexpr std::size_t kDayLags = 2;

/// Joint normal prior: natural logarithms of the lags in seconds, then the terms in their units.
struct DayPriors {
    static constexpr int kCount = static_cast<int>(kDayLags + kDayTerms);
    using Vector = Eigen::Matrix<double, kCount, 1>;
    using Matrix = Eigen::Matrix<double, kCount, kCount>;

    Vector mean = Vector::Zero();
    Matrix factor = Matrix::Identity();  ///< Lower triangular L of the covariance L L'.

    /// Combines the prior with an independent measurement of some of its quantities (Kalman
    /// update).
    ///
    /// The measurement may be very exact: variances down to 1e-20 leave a finite prior with this
    /// standard deviation (day_model_test.cpp).
    /// @param places      (m) places of the quantities, see place_of(); 0 and 1 are the lags.
    /// @param values      (m) measured values; of a lag ln(s).
    /// @param covariance  (m, m) of the values, positive definite.
    /// @throws std::invalid_argument  if the resulting covariance is not positive definite.
    void observe(const std::vector<Eigen::Index>& places, const Eigen::VectorXd& values,
                 const Eigen::MatrixXd& covariance);

    /// Returns the place of a term in `mean` and `factor`.
    [[nodiscard]] static constexpr Eigen::Index place_of(DayTerm term) {
        return static_cast<Eigen::Index>(kDayLags) + static_cast<Eigen::Index>(term);
    }
};

/// Returns the priors for a unit without calibration; fit_day() lists them.
[[nodiscard]] DayPriors usual_day_priors();

}  // namespace a351::corrector
