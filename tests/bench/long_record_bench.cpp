/// Compares the analysis of simulated long records with its promises.
///
/// Nights of the unit in the tables: the publication's statistics, computed by the product.  Units
/// drawn around it: how often the 95 % limits of the two-path fit include the true parameters, and
/// how the limits narrow with the length of the record (12 h, 3 days, 7 days).  Exits with 1 if the
/// mean of a statistic is out of its range, if the limits of a parameter include the truth in fewer
/// than 85 % of the nights, or if the limits do not narrow.  With 100 seeds or more it also exits
/// with 1 if, of all three lengths together, the limits of a slope or lag include the truth in fewer
/// than 92 % or in more than 98 %, or in fewer than 90 % of one length.
///
///     long_record_bench [FIRST_SEED [SEEDS]]
///
/// FIRST_SEED: default 9001, SEEDS: default 20.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "corrector/long_record/record_result.hpp"
#include "tests/support/plant_statistics.hpp"
#include "tests/support/published_ranges.hpp"
#include "tests/support/two_path_truth.hpp"

namespace {

using namespace a351;
using corrector::long_record::TwoPathFit;
using corrector::long_record::TwoPathTerm;

constexpr double kLeastHeld = 0.85;
constexpr double k95 = 1.96;  // Half width of 95 % limits, in standard errors.
constexpr std::uint64_t kManySeeds = 100;
/// The sum of both static slopes, behind the parameters.
constexpr auto kStaticSlope = static_cast<TwoPathTerm>(corrector::long_record::kTwoPathTerms);

struct Seeds {
    std::uint64_t first = 9001, count = 20;
};

bool statistics_are_in_range(Seeds seeds) {
    const sim::scenario::Scenario scenario = sim::scenario::load_scenario("indoor");
    std::map<std::string, sim::Figure> figures;
    for (std::uint64_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed) {
        const sim::IndoorRecord record = sim::indoor_record(scenario, seed);
        corrector::long_record::RecordResult result;
        result.parts.segments.emplace_back();
        result.parts.segments[0].quantity = record.difference_mgal;
        result.parts.segments[0].temperature_degc = record.temperature_degc;
        result.options.ensemble_size = 60;
        result.analysis = corrector::long_record::analyse_record(
            result.segment(), sim::IndoorRecord::kStepSeconds, result.options);
        for (const corrector::long_record::RecordStatistic& statistic :
             corrector::long_record::record_statistics(result)) {
            sim::Figure& figure = figures[statistic.key];
            figure.published = statistic.published;
            figure.values.push_back(statistic.value);
        }
    }
    std::printf(
        "12 h (indoor), the tables' unit, %llu seeds; accepted: the mean\n  %-30s %10s %22s"
        "  %-14s %s\n",
        static_cast<unsigned long long>(seeds.count), "", "published", "simulated", "accepted",
        "single ones within");
    bool all = true;
    for (const sim::PublishedRange& range : sim::kPublishedRanges) {
        sim::Figure& figure = figures[std::string(range.key)];
        figure.low = range.low;
        figure.high = range.high;
        const auto within = std::count_if(
            figure.values.begin(), figure.values.end(),
            [&range](double value) { return value >= range.low && value <= range.high; });
        // If no mode has the cycle of a night, the statistics of the modes are missing for it.
        const bool good = figure.values.size() == seeds.count && figure.is_accepted();
        std::printf("  %-30s %10s %10.3f +- %8.3f  %5g ... %-6g %2td of %zu  %s\n",
                    std::string(range.key).c_str(), figure.published.c_str(), figure.mean(),
                    figure.deviation(), figure.low, figure.high, within, figure.values.size(),
                    good ? "PASS" : "FAIL");
        all = all && good;
    }
    return all;
}

/// Results for one parameter over the seeds.
struct Line {
    std::string name;
    int held = 0, determined = 0;
    std::vector<double> errors, deviations;

    void add(double error, double deviation, bool is_determined) {
        errors.push_back(error);
        deviations.push_back(deviation);
        held += std::abs(deviation) <= k95 ? 1 : 0;
        determined += is_determined ? 1 : 0;
    }
    [[nodiscard]] double median_error() const {
        std::vector<double> values = errors;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    }
    [[nodiscard]] double rms_deviation() const {
        double sum = 0.0;
        for (const double value : deviations) sum += value * value;
        return std::sqrt(sum / static_cast<double>(deviations.size()));
    }
};

/// Results for all parameters; the last line is the static slope.
struct Count {
    std::array<Line, static_cast<std::size_t>(kStaticSlope) + 1> lines;
    int adequate = 0;

    void add(const TwoPathFit& fit, const sim::TwoPathTruth& truth) {
        for (std::size_t k = 0; k < corrector::long_record::kTwoPathTerms; ++k) {
            const corrector::long_record::FittedParameter& parameter = fit.parameters.at(k);
            lines[k].name = parameter.key;
            lines[k].add(parameter.standard_error,
                         sim::deviation(fit, truth, static_cast<TwoPathTerm>(k)),
                         parameter.is_determined);
        }
        lines.back().name = "static_slope_mgal_per_degc";
        lines.back().add(fit.static_slope_error, sim::static_slope_deviation(fit, truth),
                         fit.is_static_slope_determined);
        adequate += fit.unexplained.empty() ? 1 : 0;
    }

    /// Prints the lines and returns true if the limits of every parameter include the truth often
    /// enough.
    bool print(const std::string& title) const {
        const std::size_t seeds = lines[0].errors.size();
        std::printf("%s, %zu seeds; residual adequate in %d\n  %-28s %13s %5s %11s %11s\n",
                    title.c_str(), seeds, adequate, "", "median error", "held", "determined",
                    "rms off/err");
        bool all = true;
        for (const Line& line : lines) {
            const bool good = line.held >= kLeastHeld * static_cast<double>(seeds);
            std::printf("  %-28s %13.3f %5d %11d %11.2f  %s\n", line.name.c_str(),
                        line.median_error(), line.held, line.determined, line.rms_deviation(),
                        good ? "PASS" : "FAIL");
            all = all && good;
        }
        return all;
    }
};

TwoPathFit fitted(const sim::IndoorRecord& record, std::size_t samples) {
    const auto first = [samples](const std::vector<double>& values) {
        return std::vector<double>(
            values.begin(),
            values.begin() + static_cast<std::ptrdiff_t>(std::min(samples, values.size())));
    };
    return corrector::long_record::fit_two_paths(first(record.temperature_degc),
                                                 first(record.difference_mgal),
                                                 sim::IndoorRecord::kStepSeconds, 900.0);
}

/// Fits the first hours of records of units drawn within +-scatter.
Count counted(const std::string& name, double scatter, double hours, Seeds seeds) {
    sim::scenario::Scenario scenario = sim::scenario::load_scenario(name);
    scenario.unit_scatter = scatter;
    Count count;
    for (std::uint64_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed)
        count.add(
            fitted(sim::indoor_record(scenario, seed),
                   static_cast<std::size_t>(hours * 180.0)),  // 180 samples of 20 s in an hour
            sim::two_path_truth(scenario, seed));
    return count;
}

bool narrows(const Count& shorter, const Count& longer, const std::string& title) {
    std::printf("%s: errors by the factor", title.c_str());
    bool all = true;
    for (std::size_t k = 0; k < shorter.lines.size(); ++k) {
        const double factor = longer.lines[k].median_error() / shorter.lines[k].median_error();
        std::printf(" %.2f", factor);
        all = all && factor < 1.0;
    }
    std::printf("  %s\n", all ? "PASS" : "FAIL");
    return all;
}

/// Returns true if the limits of slopes and lags include the truth as often as 95 % limits should.
bool holds(const std::vector<Count>& lengths) {
    constexpr double kLeast = 0.92, kMost = 0.98, kLeastOfOne = 0.90;
    bool all = true;
    std::printf("limits that include the truth, %%: all lengths (12 h, 3 days, 7 days)\n");
    for (const TwoPathTerm term : {TwoPathTerm::fast, TwoPathTerm::slow, TwoPathTerm::fast_lag,
                                   TwoPathTerm::slow_lag, kStaticSlope}) {
        double sum = 0.0, least = 1.0;
        std::string shares;
        for (const Count& count : lengths) {
            const Line& line = count.lines.at(static_cast<std::size_t>(term));
            const double share = line.held / static_cast<double>(line.errors.size());
            sum += share / static_cast<double>(lengths.size());
            least = std::min(least, share);
            shares += ' ' + std::to_string(100.0 * share).substr(0, 4);
        }
        const bool good = sum >= kLeast && sum <= kMost && least >= kLeastOfOne;
        std::printf("  %-28s %5.1f (%s )  %s\n",
                    lengths[0].lines.at(static_cast<std::size_t>(term)).name.c_str(), 100.0 * sum,
                    shares.c_str(), good ? "PASS" : "FAIL");
        all = all && good;
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    Seeds seeds;
    if (argc > 1) seeds.first = static_cast<std::uint64_t>(std::atoll(argv[1]));
    if (argc > 2) seeds.count = static_cast<std::uint64_t>(std::atoll(argv[2]));
    bool all = statistics_are_in_range(seeds);
    const Count night = counted("indoor", 0.25, 12.0, seeds);
    all = night.print("12 h (indoor), units within +-25 %") && all;
    all = counted("indoor", 0.6, 12.0, seeds).print("12 h (indoor), units within +-60 %") && all;
    const Count days = counted("week", 0.25, 72.0, seeds);
    days.print("3 days (week), units within +-25 %");
    const Count week = counted("week", 0.25, 168.0, seeds);
    week.print("7 days (week), units within +-25 %");
    all = narrows(night, days, "3 days by 12 h") && all;
    all = narrows(days, week, "7 days by 3") && all;
    if (seeds.count >= kManySeeds) all = holds({night, days, week}) && all;
    std::printf("%s\n", all ? "all promises kept" : "NOT REACHED: see FAIL");
    return all ? 0 : 1;
}
