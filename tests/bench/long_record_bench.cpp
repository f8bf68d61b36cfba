/// How often the 95 % limits of the two-path fit hold the simulated unit's parameters, and how they
/// narrow with the record: 12 h, 3 days, 7 days.  Exits 1 when a night's hold in fewer than 85 % of all.
///
///     long_record_bench [FIRST_SEED [SEEDS]]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "corrector/fixed_point/two_path_fit.hpp"
#include "tests/support/plant_statistics.hpp"

namespace {

using namespace a351;
using corrector::TwoPathFit;
using corrector::TwoPathTerm;

struct Truth {
    TwoPathTerm term;
    double value;
    bool is_lag;
};

/// Of the scenarios' plant; rF = 950 mGal/degC x 43 s.
constexpr std::array<Truth, 5> kTruths{{{TwoPathTerm::level, -12.0, false},
                                        {TwoPathTerm::fast, 950.0 * 43.0 / 3600.0, false},
                                        {TwoPathTerm::slow, -20.0, false},
                                        {TwoPathTerm::fast_lag, 43.0, true},
                                        {TwoPathTerm::slow_lag, 2700.0, true}}};

struct Line {
    std::string name;
    int held = 0, determined = 0;
    std::vector<double> values, errors;
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Share of all limits that hold.
double report(const std::string& title, const std::vector<TwoPathFit>& fits) {
    std::vector<Line> lines(kTruths.size() + 1);
    lines.back().name = "static_slope_mgal_per_degc";
    int adequate = 0;
    for (const TwoPathFit& fit : fits) {
        for (std::size_t k = 0; k < kTruths.size(); ++k) {
            const corrector::FittedParameter& parameter = fit[kTruths[k].term];
            const double deviation =
                kTruths[k].is_lag ? parameter.value * std::log(parameter.value / kTruths[k].value)
                                  : parameter.value - kTruths[k].value;
            lines[k].name = parameter.key;
            lines[k].held += std::abs(deviation) <= 1.96 * parameter.standard_error ? 1 : 0;
            lines[k].determined += parameter.is_determined ? 1 : 0;
            lines[k].values.push_back(parameter.value);
            lines[k].errors.push_back(parameter.standard_error);
        }
        lines.back().held += std::abs(fit.static_slope + 32.0) <= 1.96 * fit.static_slope_error;
        lines.back().determined += fit.is_static_slope_determined ? 1 : 0;
        lines.back().values.push_back(fit.static_slope);
        lines.back().errors.push_back(fit.static_slope_error);
        adequate += fit.unexplained.empty() ? 1 : 0;
    }
    std::printf("%s, %zu seeds; residual adequate in %d\n  %-28s %10s %10s %6s %10s\n",
                title.c_str(), fits.size(), adequate, "", "median", "error", "held", "determined");
    int held = 0;
    for (const Line& line : lines) {
        std::printf("  %-28s %10.2f %10.2f %6d %10d\n", line.name.c_str(), median(line.values),
                    median(line.errors), line.held, line.determined);
        held += line.held;
    }
    return held / static_cast<double>(lines.size() * fits.size());
}

TwoPathFit fitted(const sim::IndoorRecord& record, std::size_t samples) {
    const auto first = [samples](const std::vector<double>& values) {
        return std::vector<double>(
            values.begin(),
            values.begin() + static_cast<std::ptrdiff_t>(std::min(samples, values.size())));
    };
    return corrector::fit_two_paths(first(record.temperature_degc), first(record.difference_mgal),
                                    sim::IndoorRecord::kStepSeconds, 900.0);
}

}  // namespace

int main(int argc, char** argv) {
    const long first = argc > 1 ? std::atol(argv[1]) : 1;
    const long count = argc > 2 ? std::atol(argv[2]) : 20;
    constexpr std::size_t kDay = 4320;  // samples of 20 s
    const sim::Scenario indoor = sim::load_scenario("indoor"), week = sim::load_scenario("week");
    std::vector<TwoPathFit> nights, days, weeks;
    for (long seed = first; seed < first + count; ++seed) {
        const auto number = static_cast<std::uint64_t>(seed);
        nights.push_back(fitted(sim::indoor_record(indoor, number), kDay));
        const sim::IndoorRecord record = sim::indoor_record(week, number);
        days.push_back(fitted(record, 3 * kDay));
        weeks.push_back(fitted(record, 7 * kDay));
    }
    const double share = report("12 h (indoor)", nights);
    report("3 days (week)", days);
    report("7 days (week)", weeks);
    std::printf("limits of a night hold in %.0f %% (85 or more: %s)\n", 100.0 * share,
                share >= 0.85 ? "PASS" : "FAIL");
    return share >= 0.85 ? 0 : 1;
}
