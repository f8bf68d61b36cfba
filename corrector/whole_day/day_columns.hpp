#pragma once
/// @file
/// The day's temperature behind a first-order lag, and its means at the bins.

#include <Eigen/Core>
#include <vector>

#include "corrector/reading/day_record.hpp"

namespace a351::corrector {

/// Returns the response of a first-order lag to a series: tau y' = x - y.
///
/// x is a straight line between samples, and y = x at the first sample (equilibrium).  The
/// recursion is exact for this x:
///
///     y_i = k y_(i-1) + (1 - k) x_(i-1) + (1 - (1 - k) / h) (x_i - x_(i-1)),
///     h = step / tau,   k = exp(-h)
///
/// A NaN makes all later values NaN.
/// Accuracy: a ramp agrees with its exact response within 1e-13 of its values
/// (day_columns_test.cpp).
/// @param series  x (n), at constant rate.
/// @param tau_s   time constant of the lag, s, > 0.
/// @return y (n), in the unit of the series.
[[nodiscard]] std::vector<double> lagged(const TimeSeries<DegC>& series, double tau_s);

/// Means of a series on the day's grid over the samples of every bin.
///
/// Between the grid's samples the series is a straight line; before the first and after the last
/// sample it is constant.
class BinMeans {
public:
    /// @param grid  series whose times are the grid, at least one sample; its values are not used.
    /// @param bins  (bins), each with at least one sample.
    BinMeans(const TimeSeries<DegC>& grid, const std::vector<DayBin>& bins);

    /// Returns the means over the bins (bins), in the unit of the values.
    /// @param values  (grid) values on the grid.
    [[nodiscard]] Eigen::VectorXd of(const std::vector<double>& values) const;

private:
    /// Position of a sample between two samples of the grid.
    struct Place {
        std::size_t before, after;  ///< Numbers of the grid's samples beside it.
        double share;               ///< Weight of the second, 0 to 1.
    };
    std::vector<Place> places_;      ///< Positions of all samples, bin by bin.
    std::vector<std::size_t> ends_;  ///< End of each bin in places_.
};

}  // namespace a351::corrector
