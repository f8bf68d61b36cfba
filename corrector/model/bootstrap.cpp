#include "corrector/model/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace a351::corrector {

std::optional<Interval> bootstrap_rms_interval(const std::vector<double>& errors,
                                               const std::vector<std::string>& stations,
                                               std::uint64_t seed) {
    struct Station {
        std::string name;
        double squares = 0.0;
        double count = 0.0;
    };
    std::vector<Station> sums;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        auto at = std::find_if(sums.begin(), sums.end(),
                               [&](const Station& s) { return s.name == stations[i]; });
        if (at == sums.end()) at = sums.insert(sums.end(), {stations[i]});
        at->squares += errors[i] * errors[i];
        at->count += 1.0;
    }
    if (sums.size() < 2) return std::nullopt;

    // The distributions of <random> differ between libraries; the generator is the same everywhere.
    std::mt19937_64 generator(seed);
    std::vector<double> values;
    for (int draw = 0; draw < kBootstrapDraws; ++draw) {
        double squares = 0.0;
        double count = 0.0;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const Station& station = sums[generator() % sums.size()];
            squares += station.squares;
            count += station.count;
        }
        values.push_back(std::sqrt(squares / count));
    }
    std::sort(values.begin(), values.end());
    // Values outside either limit: 2.5 % of the draws.
    constexpr auto kTail = static_cast<std::size_t>(kBootstrapDraws / 40);
    return Interval{values[kTail], values[values.size() - 1 - kTail]};
}

}  // namespace a351::corrector
