#pragma once
/// @file
/// Means of the day's temperature, or of a function of it, at the bins.
///
/// A column of the whole-day model is a mean over the same samples as the reading, not a value at
/// the middle of the bin.  A disturbed part of a bin, which the reading leaves out, is thus left
/// out of the temperature too.
///
///     const LaggedMeans temperature(day);
///     const Eigen::VectorXd degc = temperature.means().of(day.temperature.series.values());
///     const auto [fast_degc, slow_degc] = temperature.behind({43.0, 2700.0});

#include <Eigen/Core>
#include <array>
#include <map>
#include <mutex>
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

/// Means over the bins of a day's temperature behind a first-order lag.
///
/// Each lag is computed once and kept, because the searches with one reference hidden in turn, and those
/// for mistakes, ask for the same lags: 57 % of the calls on a day of 19 readings.  Several threads may
/// ask at a time.
class LaggedMeans {
public:
    /// @param record  kept by reference.
    explicit LaggedMeans(const reading::DayRecord& record)
        : record_(record), means_(record.temperature.series, record.bins) {}

    [[nodiscard]] const BinMeans& means() const { return means_; }
    /// Returns the means (bins) behind each of two lags, degC.
    /// @param lags_s  as unit::lagged().
    [[nodiscard]] std::array<Eigen::VectorXd, 2> behind(const std::array<double, 2>& lags_s) const;

private:
    const reading::DayRecord& record_;
    BinMeans means_;
    mutable std::mutex mutex_;
    mutable std::map<double, Eigen::VectorXd> kept_;  ///< Means by lag, s.
};

}  // namespace a351::corrector::whole_day
