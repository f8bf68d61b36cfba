#pragma once
/// @file
/// The whole-day model as a regression whose columns depend on the lags, and how likely they are.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_columns.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector {

/// As matrices count.
inline constexpr auto kLags = static_cast<Eigen::Index>(kDayLags);
inline constexpr auto kTerms = static_cast<Eigen::Index>(kDayTerms);

/// Of a noise: median x factor^u, u normal.
struct LogNormalPrior {
    double median = 0.0, factor = 1.0;
    [[nodiscard]] double at(double u) const;
};

/// Places in DayFit::Point.
enum DayHyper : std::size_t { kFastLag, kSlowLag, kPlacement, kFlicker, kWhite };

/// Readings and columns of fit_day(); estimated are the terms, then the unknowns.  Held by reference.
class DayProblem {
public:
    using Point = DayFit::Point;

    DayProblem(const DayRecord& record, const std::vector<DayStation>& stations,
               const DayPriors& priors);

    [[nodiscard]] Eigen::Index unknowns() const { return unknowns_; }
    [[nodiscard]] Eigen::Index estimated() const {
        return static_cast<Eigen::Index>(kDayTerms) + unknowns_;
    }

    /// What is estimated, as a straight function of the point's lags and of the scaled coefficients.
    /// @return (estimated)
    [[nodiscard]] Eigen::VectorXd unscaled(const Point& u, const Eigen::VectorXd& scaled) const;
    /// (estimated, estimated + 2): its derivative, that by the lags last.
    [[nodiscard]] Eigen::MatrixXd unscaling() const;

    [[nodiscard]] DayNoise noise(const Point& u) const;

    /// Roots of the expected variances, where noise() has the most likely ones: larger, for their
    /// distribution is skew.  By the curvature of the cost, taken for log-normal.
    /// @param u  most likely.
    [[nodiscard]] DayNoise expected_noise(const Point& u) const;
    [[nodiscard]] double lag_s(const Point& u, DayHyper lag) const;

    /// The point most likely by data and priors.
    [[nodiscard]] Point most_likely(const std::optional<Point>& nearby) const;

    /// - log (restricted likelihood x priors), up to a constant.
    [[nodiscard]] double cost(const Point& u) const;

    /// (n, estimated) in the units of the terms.
    [[nodiscard]] Eigen::MatrixXd design(const Point& u) const;

    /// (n, 1 + estimated): readings less what the priors expect, then the design for coefficients
    /// whose own priors are independent and of variance 1.
    [[nodiscard]] Eigen::MatrixXd scaled(const Point& u) const;

    /// (n, 2): what the point's lags change in the readings, per unit.
    /// @param values  (estimated), from unscaled().
    [[nodiscard]] Eigen::MatrixXd lag_columns(const Point& u, const Eigen::VectorXd& values) const;

    [[nodiscard]] const BinMeans& means() const { return means_; }
    /// (n) less tide and gravity, held or rough.
    [[nodiscard]] const Eigen::VectorXd& readings_mgal() const { return readings_mgal_; }
    /// Of each unknown, from which its estimate counts.
    [[nodiscard]] const std::vector<double>& rough_mgal() const { return rough_mgal_; }

private:
    void set_readings();
    void set_fixed_columns();
    [[nodiscard]] Eigen::VectorXd fast_column(double lag_s) const;
    [[nodiscard]] Eigen::VectorXd slow_column(double lag_s) const;

    const DayRecord& record_;
    const std::vector<DayStation>& stations_;
    const DayPriors& priors_;
    Eigen::Index unknowns_;
    BinMeans means_;
    LogNormalPrior white_mgal_;
    std::vector<double> rough_mgal_;
    Eigen::VectorXd readings_mgal_;
    Eigen::MatrixXd fixed_;  ///< The design, lagged columns left 0.
};

}  // namespace a351::corrector
