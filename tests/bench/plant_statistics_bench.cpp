/// Compares the simulated plant with the published figures, over many seeds.  Exits with 1 if a
/// figure is out of its range.

#include <cstdio>

#include "tests/support/plant_statistics.hpp"

namespace {

bool report(const char* title, const std::vector<a351::sim::Figure>& figures) {
    std::printf("%s, %zu seeds\n  %-58s %10s %22s  %s\n", title, figures.front().values.size(), "",
                "published", "simulated", "accepted");
    bool all = true;
    for (const a351::sim::Figure& figure : figures) {
        const bool good = figure.is_accepted();
        std::printf("  %-58s %10s %10.3f +- %8.3f  %g ... %g  %s\n", figure.name.c_str(),
                    figure.published.c_str(), figure.mean(), figure.deviation(), figure.low,
                    figure.high, good ? "PASS" : "FAIL");
        all = all && good;
    }
    return all;
}

}  // namespace

int main() {
    constexpr int kIndoorSeeds = 20, kEemdSeeds = 5, kDaySeeds = 200;
    bool all = report("Indoors", a351::sim::indoor_figures(kIndoorSeeds));
    all = report("Indoors, decomposed", a351::sim::indoor_eemd_figures(kEemdSeeds)) && all;
    all = report("Survey day", a351::sim::survey_day_figures(kDaySeeds)) && all;
    return all ? 0 : 1;
}
