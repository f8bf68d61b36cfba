#include "corrector/whole_day/day_columns.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::whole_day {

BinMeans::BinMeans(const TimeSeries<DegC>& grid, const std::vector<reading::DayBin>& bins) {
    const auto last = static_cast<double>(grid.size() - 1);
    for (const reading::DayBin& bin : bins) {
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

std::array<Eigen::VectorXd, 2> LaggedMeans::behind(const std::array<double, 2>& lags_s) const {
    {
        const std::scoped_lock lock(mutex_);
        const auto first = kept_.find(lags_s[0]), second = kept_.find(lags_s[1]);
        if (first != kept_.end() && second != kept_.end()) return {first->second, second->second};
    }
    const auto series = unit::lagged(record_.temperature.series, lags_s);
    std::array<Eigen::VectorXd, 2> means{means_.of(series[0]), means_.of(series[1])};
    const std::scoped_lock lock(mutex_);
    for (std::size_t k = 0; k < means.size(); ++k) kept_.emplace(lags_s.at(k), means.at(k));
    return means;
}

}  // namespace a351::corrector::whole_day
