#include "corrector/reading/trend_curve.hpp"

#include <cmath>
#include <numbers>
#include "tests/support/catch.hpp"

#include "corrector/eemd/extrema.hpp"
#include "corrector/reading/smoother.hpp"
#include "tests/support/white_noise.hpp"

using namespace a351::corrector::eemd;

namespace a351::corrector::reading {
namespace {

Component component(std::vector<double> values, std::size_t extrema) {
    Component out;
    out.mean_period_samples =
        2.0 * static_cast<double>(values.size()) / static_cast<double>(extrema);
    out.values = std::move(values);
    out.extrema_count = extrema;
    return out;
}

}  // namespace

TEST_CASE("the paper's curve is the residue plus the slowest mode that is not zero") {
    eemd::Result result;
    result.modes = {component({1, 1}, 90), component({2, 2}, 5), component({4, 4}, 8),
                    component({0, 0}, 0)};
    result.residue = component({100, 100}, 0);
    CHECK(paper_curve(result) == std::vector<double>{102, 102});
}

TEST_CASE("without modes the paper's curve is the residue") {
    eemd::Result result;
    result.residue = component({3, 4}, 0);
    CHECK(paper_curve(result) == std::vector<double>{3, 4});
}

TEST_CASE("the slow curve is the residue after the fewest modes that leave at most seven extrema") {
    std::vector<double> signal(450);
    fill_white_noise(3, 0, signal);
    for (std::size_t i = 0; i < 450; ++i) signal[i] += 0.02 * static_cast<double>(i);
    eemd::Options options;
    const std::vector<double> trend = trend_curve(signal, options, TrendCurve::slow);
    CHECK(count_extrema(trend) <= 7);
    int modes = 0;
    for (options.mode_count = 0; *options.mode_count < 8; ++*options.mode_count) {
        const eemd::Result result = eemd::eemd(signal, options);
        if (result.residue.extrema_count > 7) continue;
        CHECK(trend == result.residue.values);
        modes = *options.mode_count;
        break;
    }
    CHECK(modes > 2);
}

TEST_CASE(
    "on records of 15 minutes the slow curve is better than the paper's, and the smoother better "
    "than both") {
    // This is why TrendCurve::slow and a cut-off of 300 s are the defaults: root mean square errors
    // over 16 records of 2 s samples with drift, a wave of about 15 minutes, and white noise half
    // as large.
    double squares[3] = {0.0, 0.0, 0.0};
    for (std::uint64_t record = 0; record < 16; ++record) {
        std::vector<double> noise(450);
        fill_white_noise(99, record, noise);
        std::vector<double> truth(450), signal(450);
        const double phase = 0.4 * static_cast<double>(record);
        const double period = 350.0 + 15.0 * static_cast<double>(record);
        for (std::size_t i = 0; i < 450; ++i) {
            const double t = static_cast<double>(i);
            truth[i] = 0.003 * t + std::sin(2.0 * std::numbers::pi * t / period + phase);
            signal[i] = truth[i] + 0.5 * noise[i];
        }
        eemd::Options options;
        options.seed = record;
        const std::vector<double> curves[] = {trend_curve(signal, options, TrendCurve::paper),
                                              trend_curve(signal, options, TrendCurve::slow),
                                              smooth(signal, 150.0).curve};
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < 450; ++i) {
                const double error = curves[k][i] - truth[i];
                squares[k] += error * error / (16.0 * 450.0);
            }
        }
    }
    INFO("paper " << std::sqrt(squares[0]) << ", slow " << std::sqrt(squares[1]) << ", smoother "
                  << std::sqrt(squares[2]));
    // The limits are 1.1 times the figures of decimation.md.
    CHECK(squares[1] < squares[0]);
    CHECK(std::sqrt(squares[1]) < 1.1 * 0.091);
    CHECK(squares[2] < squares[1]);
    CHECK(std::sqrt(squares[2]) < 1.1 * 0.063);
}

}  // namespace a351::corrector::reading
