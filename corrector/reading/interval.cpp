#include "corrector/reading/interval.hpp"

#include <cassert>

#include "corrector/eemd/extrema.hpp"

namespace a351::corrector::reading {

Part choose_part(const std::vector<bool>& disturbed, std::size_t margin) {
    assert(!disturbed.empty());
    const std::size_t n = disturbed.size();
    Part longest;
    std::size_t longest_size = 0;
    std::size_t begin = 0;
    const auto close = [&](std::size_t end) {
        if (end - begin <= longest_size) return;
        longest_size = end - begin;
        longest.first = begin;
        longest.last = end - 1;
    };
    for (std::size_t i = 0; i < n; ++i) {
        const bool is_pulse = disturbed[i] && i > margin && n - 1 - i > margin;
        if (!is_pulse) continue;
        close(i);
        begin = i + 1;
    }
    close(n);
    longest.disturbed_first = longest.first > 0;
    longest.disturbed_last = longest.last + 1 < n;
    longest.split = longest.disturbed_first || longest.disturbed_last;
    for (std::size_t i = longest.first; i <= longest.last; ++i) {
        if (!disturbed[i]) continue;
        if (i <= margin) longest.disturbed_first = true;
        if (n - 1 - i <= margin) longest.disturbed_last = true;
    }
    return longest;
}

Interval choose_interval(std::span<const double> curve, bool disturbed_first, bool disturbed_last) {
    assert(!curve.empty());
    const std::vector<std::size_t> extrema = eemd::extremum_indices(curve);
    const std::size_t count = extrema.size();
    Interval interval{0, curve.size() - 1, (disturbed_first || disturbed_last) && count < 2};
    if (count > 0 && disturbed_first) interval.first = extrema[count == 1 ? 0 : 1];
    if (count > 0 && disturbed_last) interval.last = extrema[count == 1 ? 0 : count - 2];
    if (curve.size() > 1 && interval.first >= interval.last) {
        interval.fallback = true;
        interval.first = count >= 2 ? extrema.front() : 0;
        interval.last = count >= 2 ? extrema.back() : curve.size() - 1;
    }
    return interval;
}

}  // namespace a351::corrector::reading
