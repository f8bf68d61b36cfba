#include "corrector/long_record/record_noise.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/signal/fourier.hpp"
#include "protocol/signal/regression.hpp"

namespace a351::corrector::long_record {
namespace {

/// Ratio to the least scatter below which an average is as good.
constexpr double kHardlyMore = 1.1;

std::vector<NoiseBand> noise_spectrum(const std::vector<double>& values, double step_s) {
    const std::vector<double> centred = signal::without_line(values);
    const std::size_t length = signal::fast_length(centred.size());
    const signal::Spectrum spectrum = signal::half_spectrum(centred, length);
    const double df_hz = 1.0 / (static_cast<double>(length) * step_s);
    const double third = std::cbrt(2.0);
    constexpr std::size_t kFewest = 3;  // frequencies in a band; fewer say nothing
    std::vector<NoiseBand> bands;
    // From a quarter of the record on: without the line, longer periods are missing.
    for (std::size_t k = 4; k < spectrum.size();) {
        const auto end =
            std::min(spectrum.size(),
                     std::max(k + kFewest,
                              static_cast<std::size_t>(std::ceil(static_cast<double>(k) * third))));
        if (end - k < kFewest) break;
        double power = 0.0, frequencies = 0.0;
        for (std::size_t i = k; i < end; ++i) {
            power += 2.0 * std::norm(spectrum[i]) * step_s / static_cast<double>(centred.size());
            frequencies += static_cast<double>(i) * df_hz;
        }
        const auto count = static_cast<double>(end - k);
        bands.push_back({count / frequencies, power / count});
        k = end;
    }
    std::ranges::reverse(bands);
    return bands;
}

/// Returns the effect of the three squared noises on the variance of averages over t, unit noises.
Eigen::Vector3d variances_at(double t_s) {
    return {1.0 / t_s, 2.0 * std::numbers::ln2 / std::numbers::pi, t_s / 3.0};
}

/// Fits the squares of the noises, not negative, by coordinate descent, which converges because the
/// squares of the misfits are convex.
Eigen::Vector3d fit_noises(const std::vector<AllanDeviation>& allan, double duration_s) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const AllanDeviation& point : allan) {
        const double variance = point.deviation_mgal * point.deviation_mgal;
        if (!(variance > 0.0)) continue;
        const double weight = duration_s / point.averaging_s;
        const Eigen::Vector3d row = variances_at(point.averaging_s) / variance;
        normal += weight * row * row.transpose();
        right += weight * row;
    }
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    constexpr int kRounds = 10'000;
    for (int round = 0; round < kRounds; ++round)
        for (Eigen::Index i = 0; i < squares.size(); ++i) {
            const double rest = right(i) - normal.row(i).dot(squares) + normal(i, i) * squares(i);
            squares(i) = normal(i, i) > 0.0 ? std::max(0.0, rest / normal(i, i)) : 0.0;
        }
    return squares;
}

/// Returns the rms difference of averages over `samples` that begin `apart` samples from each other,
/// divided by sqrt(2).
double scatter_apart(const std::vector<double>& values, std::size_t samples, std::size_t apart) {
    std::vector<double> sums(values.size() + 1, 0.0);
    const double mean = signal::mean_of(values);
    for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i] - mean;
    const std::size_t count = values.size() - apart - samples + 1;
    double squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double change =
            (sums[i + apart + samples] - sums[i + apart] - sums[i + samples] + sums[i]) /
            static_cast<double>(samples);
        squares += change * change;
    }
    return std::sqrt(0.5 * squares / static_cast<double>(count));
}

}  // namespace

RecordNoise record_noise(const std::vector<double>& values, double step_s) {
    RecordNoise noise;
    noise.spectrum = noise_spectrum(values, step_s);
    for (std::size_t samples = 1; samples <= values.size() / 4; samples *= 2)
        noise.allan.push_back(
            {static_cast<double>(samples) * step_s, allan_deviation(values, samples), 0.0});
    const Eigen::Vector3d squares =
        fit_noises(noise.allan, static_cast<double>(values.size()) * step_s);
    noise.white_mgal_sqrt_s = std::sqrt(squares[0]);
    noise.flicker_mgal = std::sqrt(squares[1]);
    noise.walk_mgal_per_sqrt_s = std::sqrt(squares[2]);
    for (AllanDeviation& point : noise.allan)
        point.model_mgal = std::sqrt(variances_at(point.averaging_s).dot(squares));
    const auto apart = static_cast<std::size_t>(std::lround(kBetweenStays_s / step_s));
    if (values.size() < 3 * apart) return noise;
    for (std::size_t samples = 1; samples <= apart; samples *= 2)
        noise.stays.push_back(
            {static_cast<double>(samples) * step_s, scatter_apart(values, samples, apart)});
    const double least_mgal =
        std::ranges::min_element(noise.stays, {}, &StayScatter::scatter_mgal)->scatter_mgal;
    noise.useful = *std::ranges::find_if(noise.stays, [&](const StayScatter& stay) {
        return stay.scatter_mgal <= kHardlyMore * least_mgal;
    });
    return noise;
}

double allan_deviation(const std::vector<double>& values, std::size_t samples) {
    std::vector<double> sums(values.size() + 1, 0.0);
    const double mean = signal::mean_of(values);
    for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i] - mean;
    // With cumulative sums s: sigma^2 = 1/2 mean ((s[i+2m] - 2 s[i+m] + s[i]) / m)^2
    const std::size_t count = values.size() - 2 * samples + 1;
    double squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double change = (sums[i + 2 * samples] - 2.0 * sums[i + samples] + sums[i]) /
                              static_cast<double>(samples);
        squares += change * change;
    }
    return std::sqrt(0.5 * squares / static_cast<double>(count));
}

}  // namespace a351::corrector::long_record
