#pragma once
/// @file
/// What the whole-day model believes of lags and terms before it sees the day.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace a351::corrector {

enum class DayTerm { constant, level, slow, fast, drift, warm_up, x, y };
inline constexpr std::size_t kDayTerms = 8;

/// Fast and slow; they come first.
inline constexpr std::size_t kDayLags = 2;

/// Jointly normal: natural logarithms of the lags in seconds, then the terms in their units.
struct DayPriors {
    static constexpr int kCount = static_cast<int>(kDayLags + kDayTerms);
    using Vector = Eigen::Matrix<double, kCount, 1>;
    using Matrix = Eigen::Matrix<double, kCount, kCount>;

    Vector mean = Vector::Zero();
    Matrix factor = Matrix::Identity();  ///< L of the covariance L L', lower triangular.

    /// Takes in a measurement of some of them, independent of what is believed so far.
    /// @param covariance  positive definite, in the order of `places`.
    void observe(const std::vector<Eigen::Index>& places, const Eigen::VectorXd& values,
                 const Eigen::MatrixXd& covariance);

    [[nodiscard]] static constexpr Eigen::Index place_of(DayTerm term) {
        return static_cast<Eigen::Index>(kDayLags) + static_cast<Eigen::Index>(term);
    }
};

/// Those of a unit of which nothing is known; fit_day() lists them.
[[nodiscard]] DayPriors usual_day_priors();

}  // namespace a351::corrector
