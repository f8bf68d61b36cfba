#include "tests/support/verdict_score.hpp"

#include <algorithm>
#include <limits>

using namespace a351::daemon;

namespace a351::sim {

using daemon::verdict::State;

void VerdictScore::add(const VerdictScore& other) {
    onsets += other.onsets;
    early_s.insert(early_s.end(), other.early_s.begin(), other.early_s.end());
    delays_s.insert(delays_s.end(), other.delays_s.begin(), other.delays_s.end());
    stable_s += other.stable_s;
    false_s += other.false_s;
}

double VerdictScore::median_delay_s() const {
    if (delays_s.empty()) return std::numeric_limits<double>::infinity();
    std::vector<double> sorted = delays_s;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
}

std::vector<verdict::State> told(const VerdictRecord& record) {
    daemon::verdict::Judge judge;
    std::vector<verdict::State> states;
    for (const daemon::verdict::LiveSample& sample : record.samples) {
        const auto seen_s = static_cast<std::size_t>(seconds_between(record.start, sample.seen_at));
        states.resize(std::max(states.size(), seen_s), judge.verdict().state);
        judge.take(sample);
    }
    states.resize(record.truth.size(), judge.verdict().state);
    return states;
}

VerdictScore score(const std::vector<verdict::State>& told, const std::vector<Allowed>& truth) {
    VerdictScore score;
    const auto is_stable = [&](std::size_t i) { return told[i] == verdict::State::stable; };
    const auto next = [&](std::size_t from, auto&& is_wanted) {
        while (from < truth.size() && !is_wanted(from)) ++from;
        return from;
    };
    const auto is_overtaken = [&](std::size_t i) {
        const std::size_t from = i < kUnnoticedSeconds ? 0 : i - kUnnoticedSeconds;
        return std::count(&truth[from], &truth[i], Allowed::yes) > 0;
    };
    for (std::size_t i = 1; i < truth.size(); ++i) {
        if (is_stable(i) && truth[i] != Allowed::unknown) {
            score.stable_s += 1.0;
            score.false_s += truth[i] == Allowed::no ? 1.0 : 0.0;
            if (!is_stable(i - 1)) {
                ++score.onsets;
                const std::size_t allowed =
                    next(i, [&](std::size_t k) { return truth[k] != Allowed::no; });
                if (truth[i] == Allowed::no && allowed > i + kMostEarlySeconds && !is_overtaken(i))
                    score.early_s.push_back(static_cast<double>(i));
            }
        }
        if (truth[i] == Allowed::yes && truth[i - 1] == Allowed::no) {
            const std::size_t end =
                next(i, [&](std::size_t k) { return truth[k] != Allowed::yes; });
            const std::size_t said = next(i, is_stable);
            score.delays_s.push_back(said < end ? static_cast<double>(said - i)
                                                : std::numeric_limits<double>::infinity());
        }
    }
    return score;
}

}  // namespace a351::sim
