#pragma once
/// @file
/// Means of the day's temperature, or of a function of it, at the bins.
///
/// A column of the whole-day model is a mean over the same samples as the reading, not a value at
/// the middle of the bin.  A disturbed part of a bin, which the reading leaves out, is thus left
/// out of the temperature too.
///
///     const BinMeans means(day.temperature.series, day.bins);
///     const Eigen::VectorXd degc = means.of(day.temperature.series.values());
///     const Eigen::VectorXd slow_degc = means.of(lagged(day.temperature.series, 2700.0));

#include <Eigen/Core>
#include <vector>

#include "corrector/reading/day_record.hpp"

namespace a351::corrector::whole_day {

/// Means of a series on the day's grid over the samples of every bin.
///
/// Between the grid's samples the series is a straight line; before the first and after the last
/// sample it is constant.  Samples outside the grid are not refused.
///
/// The positions are computed once, so that of() is fast for many series on one grid.  The object
/// has no reference to grid or bins, and several threads may call of() at a time.
class BinMeans {
public:
    /// Computes the positions of all samples of the bins on the grid.
    /// @param grid  series whose times are the grid, at least one sample; its values are not used.
    /// @param bins  (bins), each with at least one sample.
    BinMeans(const TimeSeries<DegC>& grid, const std::vector<reading::DayBin>& bins);

    /// Returns the means over the bins (bins), in the unit of the values.
    ///
    /// Values with a NaN make the bins NaN that use this sample.  Cost: O(samples of all bins).
    ///
    /// Accuracy: rounding; bins between and outside the samples of a ramp have its exact means
    /// (day_columns_test.cpp).
    /// @param values  (grid) values on the grid; their number is not checked.
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

}  // namespace a351::corrector::whole_day
