#include "corrector/model/score.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace a351::corrector::model {

std::optional<double> root_mean_square(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    double squares = 0.0;
    for (const double value : values) squares += value * value;
    return std::sqrt(squares / static_cast<double>(values.size()));
}

std::optional<Interval> bootstrap_rms_interval(const std::vector<double>& errors,
                                               const std::vector<std::string>& stations,
                                               std::uint64_t seed) {
    std::vector<double> squares;
    for (const double error : errors) squares.push_back(error * error);
    auto interval = bootstrap_mean_interval(squares, stations, seed);
    if (interval) interval = Interval{std::sqrt(interval->low), std::sqrt(interval->high)};
    return interval;
}

std::optional<Interval> bootstrap_mean_interval(const std::vector<double>& values,
                                                const std::vector<std::string>& stations,
                                                std::uint64_t seed) {
    struct Station {
        std::string name;
        double sum = 0.0;
        double count = 0.0;
    };
    std::vector<Station> sums;
    for (std::size_t i = 0; i < values.size(); ++i) {
        auto at = std::ranges::find(sums, stations[i], &Station::name);
        if (at == sums.end()) at = sums.insert(sums.end(), {stations[i]});
        at->sum += values[i];
        at->count += 1.0;
    }
    if (sums.size() < 2) return std::nullopt;

    // The distributions of <random> differ between libraries; the generator is the same everywhere.
    std::mt19937_64 generator(seed);
    std::vector<double> means;
    for (int draw = 0; draw < kBootstrapDraws; ++draw) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const Station& station = sums[generator() % sums.size()];
            sum += station.sum;
            count += station.count;
        }
        means.push_back(sum / count);
    }
    std::ranges::sort(means);
    // Values outside either limit: 2.5 % of the draws.
    constexpr auto kTail = static_cast<std::size_t>(kBootstrapDraws / 40);
    return Interval{means[kTail], means[means.size() - 1 - kTail]};
}

}  // namespace a351::corrector::model
