/// Compares the verdict with the truth on simulated warm-ups, benchmark visits and disturbances,
/// and on survey days.  Exits with 1 if a promise is not kept.  Time falsely called stable is
/// listed by its cause: a touch, which counts from its faint begin until a minute after its end, or
/// the reading.
///
///     verdict_bench [FIRST LAST [DAYS]]     cases with these seeds; default 1001 1200 5
///
/// Thresholds were chosen on seeds 1 to 50 and 251 to 350, and checked on 351 to 453.  Seeds 1001
/// to 1200 were used once, with these thresholds: 0 of 3129 early, false 0.47 %, median delay
/// 126 s.  Seeds 51 to 250 were used for an earlier verdict.  For new thresholds, use other seeds
/// for the final figure.
///
/// The median is mostly from a settled oven that was touched (896 of 1201 begins of stable time).
/// After power-on the median delay is 24 min.  On visits after drives through air of another
/// temperature every second begin is not reported in time.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/support/verdict_score.hpp"

namespace {

using namespace a351::daemon;
using namespace a351;
using namespace a351::sim;
using namespace a351::sim::scenario;
using daemon::verdict::State;

void print(const char* name, const VerdictScore& score) {
    std::size_t never = 0;
    for (const double delay : score.delays_s) never += std::isinf(delay) ? 1U : 0U;
    std::printf(
        "  %-12s STABLE %4d times, more than 1 min early %zu; median delay %.0f s of %zu, not "
        "reported in time %zu; false %.2f %% of %.1f h\n",
        name, score.onsets, score.early_s.size(), score.median_delay_s(), score.delays_s.size(),
        never, 100.0 * score.false_share(), score.stable_s / 3600.0);
}

/// Returns the time in s with the verdict STABLE that the truth forbids only because of a touch.
double false_by_touch_s(const VerdictRecord& record, const std::vector<verdict::State>& states) {
    const std::vector<Allowed> untouched = allowed(record.mean_mgal, {});
    double seconds = 0.0;
    for (std::size_t i = 1; i < states.size(); ++i) {
        const bool is_false = states[i] == verdict::State::stable && record.truth[i] == Allowed::no;
        seconds += is_false && untouched[i] == Allowed::yes ? 1.0 : 0.0;
    }
    return seconds;
}

bool measure_cases(std::uint64_t first, std::uint64_t last) {
    std::array<VerdictScore, 3> by_case;
    double by_touch_s = 0.0;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        const VerdictRecord record = simulated_case(seed);
        const auto states = told(record);
        const VerdictScore one = score(states, record.truth);
        by_touch_s += false_by_touch_s(record, states);
        by_case.at(static_cast<std::size_t>(verdict_case(seed))).add(one);
        for (const double early_s : one.early_s) {
            std::printf("  seed %llu: early at %.0f s\n", static_cast<unsigned long long>(seed),
                        early_s);
        }
    }
    VerdictScore all;
    for (const VerdictScore& score : by_case) all.add(score);
    print("warm-ups", by_case[0]);
    print("visits", by_case[1]);
    print("disturbances", by_case[2]);
    print("all", all);
    std::printf("  false because of a touch %.2f %%, because of the reading %.2f %%\n",
                100.0 * by_touch_s / all.stable_s,
                100.0 * (all.false_s - by_touch_s) / all.stable_s);
    constexpr double kMostDelaySeconds = 180.0, kMostFalse = 0.01;
    return all.early_s.empty() && all.median_delay_s() <= kMostDelaySeconds &&
           all.false_share() < kMostFalse;
}

/// Prints the verdict during the occupations that the publication left out; returns true if it was
/// never STABLE.
bool measure_days(std::uint64_t days) {
    bool all = true;
    for (std::uint64_t seed = 1; seed <= days; ++seed) {
        const VerdictRecord record = verdict_record(load_scenario("tsukuba"), seed);
        const auto states = told(record);
        for (const PlannedSetUp& set_up : record.plan) {
            const auto from = static_cast<std::size_t>(seconds_between(record.start, set_up.start));
            const auto to = static_cast<std::size_t>(seconds_between(record.start, set_up.end));
            double stable_s = 0.0, settling_before_end_s = 0.0;
            for (std::size_t i = to; i-- > from;) {
                stable_s += states[i] == verdict::State::stable ? 1.0 : 0.0;
                if (states[i] == verdict::State::settling) {
                    settling_before_end_s = static_cast<double>(to - i);
                }
            }
            if (!set_up.is_outlier) continue;
            std::printf(
                "  day %llu, %s (%d): SETTLING %.1f min before the end, STABLE for %.1f min\n",
                static_cast<unsigned long long>(seed), set_up.site.name.c_str(), set_up.number,
                settling_before_end_s / 60.0, stable_s / 60.0);
            all = all && stable_s == 0.0;
        }
    }
    return all;
}

}  // namespace

int main(int count, char** arguments) {
    const auto number = [&](int i, std::uint64_t fallback) {
        return i < count ? std::strtoull(arguments[i], nullptr, 10) : fallback;
    };
    std::printf("Verdict, cases %llu to %llu\n", static_cast<unsigned long long>(number(1, 1001)),
                static_cast<unsigned long long>(number(2, 1200)));
    bool all = measure_cases(number(1, 1001), number(2, 1200));
    all = measure_days(number(3, 5)) && all;
    std::puts(all ? "PASS" : "FAIL");
    return all ? 0 : 1;
}
