/// @file
/// Measures how exactly the decomposition reproduces the reference signals, and the errors of each
/// treatment of the record's ends.  corrector/eemd/eemd.md quotes the figures.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "corrector/eemd/eemd.hpp"
#include "tests/unit/eemd/series.hpp"

namespace {

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::eemd;
using Series = std::vector<double>;

Series read_input(const std::string& name) {
    std::ifstream in(std::string(A351_GOLDEN) + "/emd/input/" + name + ".csv");
    Series values;
    for (double value = 0.0; in >> value;) values.push_back(value);
    return values;
}

double median(Series values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void report_closure(const char* name) {
    const Series signal = read_input(name);
    eemd::Options options;
    options.noise_ratio = 0.0;
    const eemd::Result plain = eemd::eemd(signal, options);
    options.noise_ratio = 0.1;
    options.ensemble_size = 160;
    const eemd::Result ensemble = eemd::eemd(signal, options);
    options.complementary_pairs = true;
    const eemd::Result pairs = eemd::eemd(signal, options);
    std::printf("%s: closure / rms  plain %.1e  pairs %.1e  ensemble %.1e (theory, rms: %.1e)\n",
                name, closure_error(signal, plain) / rms(signal),
                closure_error(signal, pairs) / rms(signal),
                closure_error(signal, ensemble) / rms(signal),
                ensemble.noise_level / std::sqrt(160.0) / rms(signal));
    std::printf("  %-8s %9s %10s %8s %12s\n", "", "extrema", "period", "share", "error / rms");
    const auto line = [](const std::string& what, const Component& component) {
        std::printf(
            "  %-8s %9zu %10.1f %8.4f %12.4f\n", what.c_str(), component.extrema_count,
            component.mean_period_samples, component.energy_share,
            component.energy_share > 0.0 ? *component.standard_error / rms(component.values) : 0.0);
    };
    for (std::size_t k = 0; k < ensemble.modes.size(); ++k) {
        line("imf" + std::to_string(k + 1), ensemble.modes[k]);
    }
    line("residue", ensemble.residue);
}

/// Returns the sum of the residue and the modes with periods of at least `period` samples.
Series slow_part(const eemd::Result& result, double period) {
    Series slow = result.residue.values;
    for (const Component& mode : result.modes) {
        if (mode.mean_period_samples < period) continue;
        for (std::size_t i = 0; i < slow.size(); ++i) slow[i] += mode.values[i];
    }
    return slow;
}

/// Adds decaying transients of 40 times the noise at both ends, as after a box was set down.
Series with_spikes(Series piece, double noise) {
    for (std::size_t i = 0; i < 15; ++i) {
        const double spike = 40.0 * noise * std::exp(-static_cast<double>(i) / 5.0);
        piece[i] += spike;
        piece[piece.size() - 1 - i] -= 0.5 * spike;
    }
    return piece;
}

struct Treatment {
    const char* name;
    EndRule ends;
    bool reflect;
};

/// Compares the slow part of pieces of the long record with that of the whole record, whose ends
/// are far away.
void report_ends(std::size_t length) {
    const Series record = read_input("s4_long20s");
    eemd::Options options;
    options.ensemble_size = 160;
    const eemd::Result whole = eemd::eemd(record, options);
    const double slow = 2.0 * static_cast<double>(length) / 7.0;  // seven extrema in a piece
    const Series truth = slow_part(whole, slow);
    const double noise = rms(whole.modes[0].values);
    std::printf("\nslow part of %zu-sample pieces of s4_long20s, median error, 1e-6 m/s^2\n",
                length);
    std::printf("  %-34s %22s %22s\n", "", "as it is: whole  ends", "spikes: whole  ends");
    for (const Treatment& treatment :
         {Treatment{"line", EndRule::line, false}, Treatment{"mirror", EndRule::mirror, false},
          Treatment{"record reflected, line", EndRule::line, true}}) {
        std::printf("  %-34s", treatment.name);
        for (const bool spikes : {false, true}) {
            Series of_whole;
            Series of_ends;
            for (std::size_t begin = length; begin + 2 * length <= record.size();
                 begin += length / 2) {
                const auto at = record.begin() + static_cast<std::ptrdiff_t>(begin);
                Series piece(at, at + static_cast<std::ptrdiff_t>(length));
                if (spikes) piece = with_spikes(piece, noise);
                options.ensemble_size = 80;
                options.ends = treatment.ends;
                options.reflect_ends = treatment.reflect;
                Series error = slow_part(eemd::eemd(piece, options), slow);
                for (std::size_t i = 0; i < length; ++i) error[i] -= truth[begin + i];
                of_whole.push_back(rms(error));
                const auto end = static_cast<std::ptrdiff_t>(length / 20);
                Series ends(error.begin(), error.begin() + end);
                ends.insert(ends.end(), error.end() - end, error.end());
                of_ends.push_back(rms(ends));
            }
            std::printf("      %8.3f %8.3f", 1e6 * median(of_whole), 1e6 * median(of_ends));
        }
        std::printf("\n");
    }
}

}  // namespace

int main() {
    report_closure("s1_sine_trend");
    report_closure("s4_long20s");
    for (const std::size_t length : {300U, 450U, 900U}) report_ends(length);
}
