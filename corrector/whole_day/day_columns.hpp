#pragma once
/// @file
/// What a lag makes of the day's temperature, at the bins.

#include <Eigen/Core>
#include <vector>

#include "corrector/reading/day_record.hpp"

namespace a351::corrector {

/// First-order lag of a series, tau y' = x - y, between samples a straight line, y = x at the first.
/// @param tau_s  > 0
[[nodiscard]] std::vector<double> lagged(const TimeSeries<DegC>& series, double tau_s);

/// A series of the day's grid as means over the samples of every bin.  Before its first sample and
/// after its last one the series is constant.
class BinMeans {
public:
    BinMeans(const TimeSeries<DegC>& grid, const std::vector<DayBin>& bins);

    /// @param values  (grid)  @return (bins)
    [[nodiscard]] Eigen::VectorXd of(const std::vector<double>& values) const;

private:
    struct Place {
        std::size_t before;
        double share;  ///< Of the next one.
    };
    std::size_t grid_size_;
    std::vector<Place> places_;      ///< Of all samples, bin by bin.
    std::vector<std::size_t> ends_;  ///< Of each bin in places_.
};

}  // namespace a351::corrector
