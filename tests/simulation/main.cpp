#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

#include "tests/simulation/simulation.hpp"

namespace {

using a351::simulation::Outcome;

void print(std::uint64_t seed, const Outcome& outcome) {
    fmt::print(
        "seed {}: {}; {:.0f} s of signal, {} faults, {} starts, {} samples, {} promised, {} "
        "archived, "
        "{} events, {} turns, digest {:x}\n",
        seed, outcome.broken.empty() ? "all invariants hold" : outcome.broken, outcome.signal_s,
        outcome.faults, outcome.runs, outcome.samples, outcome.promised, outcome.archived,
        outcome.events, outcome.turns, outcome.digest);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "Runs the recording part of the daemon in a simulated world, one run per seed, the first "
        "one twice.  A seed whose run breaks an invariant is printed.",
        "daemon-simulation");
    std::uint64_t first = 1, count = 1;
    bool is_traced = false;
    app.add_option("FIRST", first, "First seed")->required();
    app.add_option("COUNT", count, "Number of seeds; default: 1");
    app.add_flag("--trace", is_traced,
                 "Print faults and log lines with their simulated time, and keep the files");
    CLI11_PARSE(app, argc, argv);

    const auto begin = std::chrono::steady_clock::now();
    Outcome sum;
    int broken = 0, least_faults = std::numeric_limits<int>::max();
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        Outcome outcome = a351::simulation::simulate(seed, is_traced);
        if (seed == first && !is_traced &&
            a351::simulation::simulate(seed, false).digest != outcome.digest)
            outcome.broken += "; a second run took other turns";
        sum.simulated_s += outcome.simulated_s;
        sum.signal_s += outcome.signal_s;
        sum.faults += outcome.faults;
        sum.runs += outcome.runs;
        least_faults = std::min(least_faults, outcome.faults);
        if (!outcome.broken.empty()) ++broken;
        if (!outcome.broken.empty() || is_traced) print(seed, outcome);
    }
    const double real_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    fmt::print(
        "{} runs, {} broken: {:.0f} a minute, {:.0f} h simulated ({:.0f} times real time), {:.1f} "
        "h "
        "of signal, {} faults (at least {} a run), {} starts\n",
        count, broken, 60.0 * static_cast<double>(count) / real_s, sum.simulated_s / 3600.0,
        sum.simulated_s / real_s, sum.signal_s / 3600.0, sum.faults, least_faults, sum.runs);
    return broken == 0 ? 0 : 1;
}
