#include "corrector/reading/band_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace a351::corrector::reading {
namespace {

using Complex = std::complex<double>;

/// One filter section y[n] = b (x[n] - x[n-2]) - a1 y[n-1] - a2 y[n-2], with zeros at frequency 0
/// and at half the rate.
struct Section {
    double b = 0.0, a1 = 0.0, a2 = 0.0;

    void run(std::vector<double>& values) const {
        double x1 = 0.0, x2 = 0.0, y1 = 0.0, y2 = 0.0;
        for (double& value : values) {
            const double x = value;
            const double y = b * (x - x2) - a1 * y1 - a2 * y2;
            x2 = x1;
            x1 = x;
            y2 = y1;
            y1 = y;
            value = y;
        }
    }
};

std::array<Section, 2> design(double low, double high) {
    // Corners are fractions of the rate; the bilinear transformation s = (z - 1) / (z + 1) warps
    // them.
    const double w1 = std::tan(std::numbers::pi * low), w2 = std::tan(std::numbers::pi * high);
    const double width = w2 - w1, centre2 = w1 * w2;
    const Complex prototype = std::polar(1.0, 0.75 * std::numbers::pi);
    const Complex half = 0.5 * width * prototype;
    const Complex root = std::sqrt(half * half - centre2);
    const Complex at_centre(0.0, std::sqrt(centre2));
    const Complex z = (1.0 + at_centre) / (1.0 - at_centre);
    std::array<Section, 2> sections;
    for (std::size_t i = 0; i < 2; ++i) {
        const Complex s = i == 0 ? half + root : half - root;
        const Complex pole = (1.0 + s) / (1.0 - s);
        sections[i].a1 = -2.0 * pole.real();
        sections[i].a2 = std::norm(pole);
        const Complex gain =
            (1.0 - 1.0 / (z * z)) / (1.0 + sections[i].a1 / z + sections[i].a2 / (z * z));
        sections[i].b = 1.0 / std::abs(gain);
    }
    return sections;
}

}  // namespace

std::vector<double> band_pass(const std::vector<double>& values, double step_s,
                              double shorter_period_s, double longer_period_s) {
    const auto pad =
        std::min(values.size() - 1, static_cast<std::size_t>(3.0 * longer_period_s / step_s));
    std::vector<double> padded;
    for (std::size_t i = pad; i > 0; --i) padded.push_back(2.0 * values.front() - values[i]);
    padded.insert(padded.end(), values.begin(), values.end());
    for (std::size_t i = 1; i <= pad; ++i)
        padded.push_back(2.0 * values.back() - values[values.size() - 1 - i]);
    const auto sections = design(step_s / longer_period_s, step_s / shorter_period_s);
    for (int pass = 0; pass < 2; ++pass) {
        for (const Section& section : sections) section.run(padded);
        std::reverse(padded.begin(), padded.end());
    }
    const auto first = padded.begin() + static_cast<std::ptrdiff_t>(pad);
    return {first, first + static_cast<std::ptrdiff_t>(values.size())};
}

}  // namespace a351::corrector::reading
