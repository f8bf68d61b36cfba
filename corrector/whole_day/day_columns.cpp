#include "corrector/whole_day/day_columns.hpp"

#include <algorithm>
#include <cmath>

namespace a351::corrector {

std::vector<double> lagged(const TimeSeries<DegC>& series, double tau_s) {
    const double step = 1.0 / (series.rate().value() * tau_s);
    // Exact for straight lines between samples:
    // y_i = k y_(i-1) + (1 - k) x_(i-1) + (1 - (1 - k) / h) (x_i - x_(i-1))
    const double keep = std::exp(-step);
    const double of_rise = 1.0 - (1.0 - keep) / step;
    const std::vector<double>& x = series.values();
    std::vector<double> y = x;
    for (std::size_t i = 1; i < x.size(); ++i)
        y[i] = keep * y[i - 1] + (1.0 - keep) * x[i - 1] + of_rise * (x[i] - x[i - 1]);
    return y;
}

BinMeans::BinMeans(const TimeSeries<DegC>& grid, const std::vector<DayBin>& bins) {
    const auto last = static_cast<double>(grid.size() - 1);
    for (const DayBin& bin : bins) {
        for (const UtcTime time : bin.times) {
            const double place =
                std::clamp(seconds_between(grid.start(), time) * grid.rate().value(), 0.0, last);
            const double before = std::min(std::floor(place), std::max(last - 1.0, 0.0));
            const auto first = static_cast<std::size_t>(before);
            places_.push_back({first, std::min(first + 1, grid.size() - 1), place - before});
        }
        ends_.push_back(places_.size());
    }
}

Eigen::VectorXd BinMeans::of(const std::vector<double>& values) const {
    Eigen::VectorXd means(static_cast<Eigen::Index>(ends_.size()));
    std::size_t i = 0;
    for (std::size_t bin = 0; bin < ends_.size(); ++bin) {
        const std::size_t begin = i;
        double sum = 0.0;
        for (; i < ends_[bin]; ++i) {
            const Place& place = places_[i];
            sum += (1.0 - place.share) * values[place.before] + place.share * values[place.after];
        }
        means(static_cast<Eigen::Index>(bin)) = sum / static_cast<double>(i - begin);
    }
    return means;
}

}  // namespace a351::corrector
