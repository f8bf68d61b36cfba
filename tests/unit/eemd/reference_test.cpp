/// @file
/// Agreement with the tables of tests/golden/emd, whose README says how they were made and how far
/// two builds of their producer differ; ten times that is allowed here.

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include "tests/support/catch.hpp"

#include "protocol/text/text_file.hpp"
#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

std::string golden(const std::string& name) {
    return text::read_text_file(std::string(A351_GOLDEN) + "/emd/" + name);
}

std::vector<double> read_input(const std::string& name) {
    std::istringstream in(golden("input/" + name + ".csv"));
    std::vector<double> values;
    for (double value = 0.0; in >> value;) values.push_back(value);
    return values;
}

/// Returns one vector per column.
std::vector<std::vector<double>> read_table(const std::string& name) {
    std::istringstream in(golden("imf/" + name + ".csv"));
    std::vector<std::vector<double>> columns;
    for (std::string line; std::getline(in, line);) {
        std::istringstream cells(line);
        std::size_t column = 0;
        for (std::string cell; std::getline(cells, cell, ','); ++column) {
            if (column == columns.size()) columns.emplace_back();
            columns[column].push_back(std::stod(cell));
        }
    }
    return columns;
}

/// Returns the rms of the signal without its mean, or 1 for a constant.
double scale_of(std::vector<double> signal) {
    double mean = 0.0;
    for (const double value : signal) mean += value / static_cast<double>(signal.size());
    for (double& value : signal) value -= mean;
    const double scale = rms(signal);
    return scale > 1e-12 ? scale : 1.0;
}

/// Returns the largest difference over all components, relative to scale_of(input). The settings
/// say the stopping rule and whether the table has all samples or every twentieth.
double plain_difference(const std::string& input, const std::string& settings) {
    const std::size_t every = settings.ends_with("_every20") ? 20 : 1;
    const std::vector<double> signal = read_input(input);
    const auto expected = read_table(input + "__emd_" + settings);
    Options options = plain();
    options.stopping = settings.starts_with("s4") ? StoppingRule(SNumber{4}) : FixedSifts{10};
    options.finish = FinishRule::always;
    options.mode_count = static_cast<int>(expected.size()) - 1;
    const auto found = components_of(eemd(signal, options));
    REQUIRE(found.size() == expected.size());
    double largest = 0.0;
    for (std::size_t k = 0; k < found.size(); ++k) {
        REQUIRE(found[k].size() == every * expected[k].size());
        for (std::size_t i = 0; i < expected[k].size(); ++i)
            largest = std::max(largest, std::abs(found[k][every * i] - expected[k][i]));
    }
    return largest / scale_of(signal);
}

}  // namespace

TEST_CASE(
    "ten sifts and the S-number rule reproduce the reference modes, those of a long record at "
    "every twentieth sample") {
    const auto [input, settings, limit] = GENERATE(table<std::string, std::string, double>({
        {"s1_sine_trend", "fix10_m9", 2e-7},
        {"s4_long20s", "fix10_m11", 4e-14},
        {"s6_const64", "fix10_m6", 6e-15},
        {"s6_plateau64", "fix10_m6", 6e-15},
        {"s6_short2", "fix10_m1", 6e-15},
        {"s6_short4", "fix10_m2", 6e-15},
        {"s6_short16", "fix10_m4", 6e-15},
        {"s1_sine_trend", "s4max50_m9", 5e-6},
        {"s6_const64", "s4max50_m6", 6e-15},
        {"s6_plateau64", "s4max50_m6", 6e-15},
        {"s6_short2", "s4max50_m1", 6e-15},
        {"s6_short4", "s4max50_m2", 6e-15},
        // Its third mode is the curvature of a monotone remainder, sampled symmetrically. Whether
        // the two samples at its bottom differ in the last bit or are a plateau depends on earlier
        // rounding.
        {"s6_short16", "s4max50_m4", 6e-15},
        {"s4_long20s", "fix10_m12_every20", 2e-10},
        {"s4_long20s", "s4max50_m12_every20", 3e-8},
    }));
    const double difference = plain_difference(input, settings);
    INFO(input << ' ' << settings << ": " << difference);
    CHECK(difference <= limit);
}

TEST_CASE(
    "an ensemble differs from the converged one by as much as the scatter of its members "
    "predicts") {
    const std::vector<double> signal = read_input("s1_sine_trend");
    const auto expected = read_table("s1_sine_trend__eemd_eps0.1_fix10_m9_mean16000");
    const auto facts = nlohmann::json::parse(golden("sigma_member.json")).at("s1_sine_trend");
    const auto sigma = facts.at("sigma_member_rms_per_component").get<std::vector<double>>();
    Options options;
    options.ensemble_size = 640;
    options.mode_count = 8;
    options.finish = FinishRule::always;
    options.seed = 2;
    const Result result = eemd(signal, options);
    CHECK(result.noise_level == Approx(0.1 * facts.at("sd_ddof1").get<double>()).epsilon(1e-12));
    const auto found = components_of(result);
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        std::vector<double> difference(signal.size());
        for (std::size_t i = 0; i < signal.size(); ++i)
            difference[i] = found[k][i] - expected[k][i];
        const double ratio = rms(difference) / (sigma[k] * std::sqrt(1.0 / 640 + 1.0 / 16000));
        const auto& component = k < result.modes.size() ? result.modes[k] : result.residue;
        const double extrema =
            static_cast<double>(std::max<std::size_t>(component.extrema_count, 1));
        const double factor = 1.0 + 3.0 / std::sqrt(extrema);
        INFO("component " << k << ", " << extrema << " extrema, ratio " << ratio);
        CHECK(ratio < factor);
        CHECK(ratio > 1.0 / factor);
        // The other sigmas are dominated by rare members and are only known to some ten per cent.
        if (extrema < 100.0) continue;
        CHECK(*component.standard_error * std::sqrt(640.0) == Approx(sigma[k]).epsilon(0.03));
    }
}

}  // namespace a351::corrector::eemd
