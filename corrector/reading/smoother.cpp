#include "corrector/reading/smoother.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <string>

#include "corrector/reading/disturbance.hpp"
#include "protocol/signal/median.hpp"

namespace a351::corrector::reading {
namespace {

/// Largest residual of full weight, and smallest of no weight, standard deviations.  Reason: one
/// sample in 370 of Gaussian noise is beyond the first.
constexpr double kFullWeight = 3.0;
constexpr double kNoWeight = 6.0;

/// Numbers of rounds.  Nearly all weights of Gaussian noise settle within kPlainRounds.  With many
/// samples on the flanks they can alternate for ever.  Then the mean of old and new weights is
/// taken, with which most of them settle.
constexpr int kPlainRounds = 10;
constexpr int kMostRounds = 100;
/// Largest change of a weight in the last round.
constexpr double kSettled = 1e-6;

/// Smallest number of degrees of freedom of the noise, as a fraction of the samples' weight.
/// Reason: the accuracy of the trace for cut-offs of 1000 samples
/// (PenalisedFit::inverse_diagonal()).
constexpr double kLeastFreedom = 1e-6;

void require(bool condition, const std::string& trouble) {
    if (!condition) throw std::invalid_argument("smooth: " + trouble);
}

std::vector<double> weighted(std::span<const double> weights, std::span<const double> values) {
    std::vector<double> product(values.size());
    for (std::size_t i = 0; i < product.size(); ++i)
        product[i] = weights[i] == 0.0 ? 0.0 : weights[i] * values[i];
    return product;
}

double weight_of(double residual, double deviation) {
    const double magnitude = std::abs(residual);
    if (magnitude <= kFullWeight * deviation) return 1.0;
    if (magnitude >= kNoWeight * deviation) return 0.0;
    const double u = (magnitude / deviation - kFullWeight) / (kNoWeight - kFullWeight);
    return (1.0 - u * u) * (1.0 - u * u);
}

/// Returns the weights from the residuals of the samples; 0 for missing samples.
std::vector<double> weights_about(std::span<const double> series, std::span<const double> curve,
                                  double rounding) {
    std::vector<double> magnitudes;
    for (std::size_t i = 0; i < series.size(); ++i) {
        if (std::isfinite(series[i])) magnitudes.push_back(std::abs(series[i] - curve[i]));
    }
    const double deviation =
        std::max(signal::kGaussianPerMad * signal::median(std::move(magnitudes)), rounding);
    std::vector<double> weights(series.size());
    for (std::size_t i = 0; i < series.size(); ++i) {
        if (std::isfinite(series[i])) weights[i] = weight_of(series[i] - curve[i], deviation);
    }
    return weights;
}

double largest_change(std::span<const double> a, std::span<const double> b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

/// Returns the fit with its noise level and degrees of freedom, for the final weights.
SmoothTrend describe(std::span<const double> series, PenalisedFit fit, std::vector<double> curve,
                     std::vector<double> weights, bool converged) {
    const std::vector<double> inverse = fit.inverse_diagonal();
    double squares = 0.0;
    double total = 0.0;
    double degrees_of_freedom = 0.0;
    for (std::size_t i = 0; i < series.size(); ++i) {
        if (weights[i] == 0.0) continue;
        const double residual = series[i] - curve[i];
        squares += weights[i] * residual * residual;
        total += weights[i];
        degrees_of_freedom += weights[i] * inverse[i];
    }
    const double freedom = total - degrees_of_freedom;
    require(freedom >= kLeastFreedom * total, "series: the curve passes through all its samples");
    const double noise_level = std::sqrt(squares / freedom);
    return {std::move(curve),   std::move(weights), noise_level,
            degrees_of_freedom, converged,          std::move(fit)};
}

}  // namespace

std::vector<double> SmoothTrend::standard_errors() const {
    std::vector<double> errors = fit.inverse_diagonal();
    for (double& error : errors) error = noise_level * std::sqrt(error);
    return errors;
}

double SmoothTrend::standard_error_of_mean(std::size_t first, std::size_t last) const {
    assert(first <= last && last < curve.size());
    const double share = 1.0 / static_cast<double>(last - first + 1);
    std::vector<double> shares(curve.size());
    std::fill_n(shares.begin() + static_cast<std::ptrdiff_t>(first), last - first + 1, share);
    const std::vector<double> solved = fit.solve(shares);
    double variance = 0.0;
    for (std::size_t i = first; i <= last; ++i) variance += share * solved[i];
    return noise_level * std::sqrt(variance);
}

SmoothTrend smooth(std::span<const double> series, double cutoff_period) {
    require(cutoff_period >= kShortestCutoff && cutoff_period <= kLongestCutoff,
            fmt::format("cutoff_period = {:f}, must be 2 to 5000 samples", cutoff_period));
    std::vector<double> weights(series.size());
    double sum = 0.0;
    double largest = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < series.size(); ++i) {
        if (!std::isfinite(series[i])) continue;
        weights[i] = 1.0;
        sum += series[i];
        largest = std::max(largest, std::abs(series[i]));
        ++count;
    }
    require(count >= kFewestSamples, fmt::format("series: {} samples, must be 3 or more", count));
    require(largest <= kLargestSample, "series: a sample's magnitude is beyond 1e150");

    // The deviation from the mean is fitted, because rounding is relative to the fitted values.
    const double mean = sum / static_cast<double>(count);
    std::vector<double> departure(series.begin(), series.end());
    for (double& value : departure) value -= mean;

    const double penalty = penalty_of(cutoff_period);
    PenalisedFit fit(weights, penalty);
    std::vector<double> curve = fit.solve(weighted(weights, departure));
    bool converged = false;
    for (int round = 1; round < kMostRounds; ++round) {
        std::vector<double> next = weights_about(departure, curve, kSampleRounding * largest);
        converged = largest_change(next, weights) <= kSettled;
        if (converged) break;
        for (std::size_t i = 0; round >= kPlainRounds && i < next.size(); ++i)
            next[i] = 0.5 * (next[i] + weights[i]);
        weights = std::move(next);
        fit = PenalisedFit(weights, penalty);
        curve = fit.solve(weighted(weights, departure));
    }
    SmoothTrend trend =
        describe(departure, std::move(fit), std::move(curve), std::move(weights), converged);
    for (double& value : trend.curve) value += mean;
    return trend;
}

}  // namespace a351::corrector::reading
