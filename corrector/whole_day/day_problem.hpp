#pragma once
/// @file
/// The likelihood of the whole-day model: of its lags, the size of the axis biases, an outer oven's
/// effect and the noise.
///
/// It is a part of fit_day().  A point u is that of day_regression.hpp; for a fixed one the model is
/// linear:
///
///     const DayProblem problem(record, stations, priors);
///     const DayProblem::Point u = problem.most_likely(std::nullopt);
///     Eigen::MatrixXd columns = problem.scaled(u);         // readings, then columns
///     whiten(record.bins, problem.noise(u), columns);
///     // (X'X + 1)^-1 X'y of the whitened columns: scaled coefficients
///     problem.unscaled(u, scaled_coefficients);            // in the units of the terms

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_regression.hpp"

namespace a351::corrector::whole_day {

/// The regression of a day with its noise, and the search for the most likely point.
///
/// Accuracy: day_model_test.cpp, through fit_day().  ln(placement) of 20 made-up days scatters by 0.5
/// to 1.6 of noise_log_errors() (station_system_test.cpp).
///
/// Constant members may be called from several threads at a time.
class DayProblem : public DayRegression {
public:
    /// All arguments are kept by reference and must exist as long as this object.
    /// @param record, stations, priors, rough_mgal  as DayRegression.
    DayProblem(const reading::DayRecord& record, const std::vector<DayStation>& stations,
               const DayPriors& priors, const std::vector<double>& rough_mgal = {});

    /// Returns the number of parameters of a point that are searched; the others are those of an outer
    /// oven.
    [[nodiscard]] std::size_t searched() const { return has_outer() ? Point{}.size() : kOuterLag; }

    /// Returns the noise at a point.  The median of white noise is the scatter between neighbouring
    /// bins of a set-up, at least 1e-3 mGal; 1 mGal if no set-up has two bins.
    [[nodiscard]] DayNoise noise(const Point& u) const;

    /// Returns the point with this noise, and with the medians of all other parameters.
    /// @param noise  each part > 0.
    [[nodiscard]] Point point_of(const DayNoise& noise) const;

    /// Returns the point with the roots of the expected variances of placement, flicker, axis biases
    /// and an outer oven's effect; the rest as in `u`.
    ///
    /// They are larger than the most likely ones, because the distribution is skew.  It is taken as
    /// log-normal, with the variance from the curvature of the cost.
    /// @param u  most likely point.  Elsewhere the curvature means nothing.
    [[nodiscard]] Point expected(const Point& u) const;
    /// Returns ln of the factor of one deviation.
    /// @param part  placement, flicker, size of the axis biases or of an outer oven's effect.
    [[nodiscard]] double log_factor(DayHyper part) const;
    /// Returns the standard errors of the logarithms of placement, flicker and white noise, from the
    /// curvature of the cost with the other numbers held; absent if it has no minimum there.
    /// @param u  most likely point.
    [[nodiscard]] std::optional<std::array<double, 3>> noise_log_errors(const Point& u) const;

    /// Returns the point with the least cost, on the grid of search_point(), at most 12 standard
    /// deviations of the priors away.
    ///
    /// It evaluates cost() at most 2000 times and does not report if this was too few.
    /// @param nearby  start of the search; absent: the priors' medians, with the size of the axis
    ///                biases of 0, 2 and 4 deviations that has the least cost.
    [[nodiscard]] Point most_likely(const std::optional<Point>& nearby) const;

    /// Returns -ln(restricted likelihood x priors), up to a constant; infinite if it overflows.
    ///
    /// Differences between points are meaningful, the value itself is not.  Cost: one lag filter of
    /// the temperature for each lag, then O(n (1 + estimated)^2).
    [[nodiscard]] double cost(const Point& u) const { return cost(u, scaled(u)); }

    /// Returns the problem linearised at a fit: columns (n, estimated + 2) of coefficients whose
    /// priors are independent and of variance 1, the lags last, whitened with the expected noise.
    /// Their normal matrix plus 1 is the inverse of the posterior covariance.
    /// @param values  (estimated) from unscaled().
    [[nodiscard]] Eigen::MatrixXd linearised(const Point& expected,
                                             const Eigen::VectorXd& values) const;

private:
    /// Returns cost(u) from the scaled() columns of a point that differs from `u` in its noise only.
    [[nodiscard]] double cost(const Point& u, Eigen::MatrixXd columns) const;

    Whitening whitening_;
    LogNormalPrior white_mgal_;
};

}  // namespace a351::corrector::whole_day
