#include "corrector/eemd/eemd.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "corrector/eemd/ensemble.hpp"
#include "corrector/eemd/extrema.hpp"

namespace a351::corrector::eemd {
namespace {

void require(bool holds, std::string_view name, int value, std::string_view limits) {
    if (holds) return;
    throw std::invalid_argument(fmt::format("eemd: {} = {}, must be {}", name, value, limits));
}

void validate(const Options& options) {
    require(options.ensemble_size >= 1, "ensemble_size", options.ensemble_size, ">= 1");
    require(!options.complementary_pairs || options.ensemble_size % 2 == 0, "ensemble_size",
            options.ensemble_size, "even for pairs");
    if (!(options.noise_ratio >= 0.0 && std::isfinite(options.noise_ratio))) {
        throw std::invalid_argument(
            fmt::format("eemd: noise_ratio = {:f}, must be finite and >= 0", options.noise_ratio));
    }
    const int mode_count = options.mode_count.value_or(0);
    require(mode_count >= 0, "mode_count", mode_count, ">= 0");
    require(options.threads >= 1, "threads", options.threads, ">= 1");
    if (const auto* fixed = std::get_if<FixedSifts>(&options.stopping)) {
        require(fixed->count >= 1 && fixed->count <= kMaxSifts, "stopping.count", fixed->count,
                fmt::format("1 to {}", kMaxSifts));
    } else if (const auto* s_number = std::get_if<SNumber>(&options.stopping)) {
        require(s_number->repeats >= 1, "stopping.repeats", s_number->repeats, ">= 1");
    }
}

double mean_of(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// Returns the standard deviation with divisor n - 1; 0 for n < 2.
double standard_deviation(std::span<const double> values) {
    if (values.size() < 2) return 0.0;
    // The sums are about the first sample, so that a constant gives exactly zero.
    double mean = 0.0;
    for (const double value : values) mean += value - values[0];
    mean /= static_cast<double>(values.size());
    double squares = 0.0;
    for (const double value : values) {
        const double deviation = value - values[0] - mean;
        squares += deviation * deviation;
    }
    return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

// Limit of |signal|.  Between it and the largest double, 1.8e308, there is room for noise and for
// envelopes that overshoot.
constexpr double kTooLarge = 1e300;

/// Returns the binary exponent that scales `signal` to below 1, so that no step overflows or
/// underflows.
/// @throws std::invalid_argument  if a sample is not finite or too large.
int common_exponent(std::span<const double> signal) {
    double largest = 0.0;
    for (std::size_t i = 0; i < signal.size(); ++i) {
        if (!(std::abs(signal[i]) < kTooLarge)) {
            throw std::invalid_argument(
                fmt::format("eemd: signal[{}] = {:f}, must be finite and below 1e300 in magnitude",
                            i, signal[i]));
        }
        largest = std::max(largest, std::abs(signal[i]));
    }
    int exponent = 0;
    static_cast<void>(std::frexp(largest, &exponent));
    return exponent;
}

/// Returns the record with `margin` samples reflected about either end sample.
std::vector<double> reflected(std::span<const double> record, std::size_t margin) {
    std::vector<double> out;
    out.reserve(record.size() + 2 * margin);
    for (std::size_t i = margin; i >= 1; --i) out.push_back(record[i]);
    out.insert(out.end(), record.begin(), record.end());
    for (std::size_t i = 1; i <= margin; ++i) out.push_back(record[record.size() - 1 - i]);
    return out;
}

/// Relative rounding error of the sum of squares over a whole record and ensemble.
constexpr double kRounding = 1e-14;

/// Returns the standard error of the mean of one component, rms over its samples.  If the draws are
/// nearly equal, their squares and those of their mean are too; then the rounding is returned.
///
/// @param sum      sum over all members, sample by sample.
/// @param squares  sum over draws and samples of (draw - origin)^2.
/// @param draws    independent realisations of the noise; each is a sum over `draw_size` members.
std::optional<double> standard_error(std::span<const double> sum, double squares, double origin,
                                     int draws, int draw_size) {
    if (draws < 2 || sum.empty()) return std::nullopt;
    const double count = draws;
    double of_means = 0.0;
    for (const double value : sum) {
        const double deviation = value / count - origin;
        of_means += deviation * deviation;
    }
    const double variance =
        std::max(kRounding * squares, squares - count * of_means) / (count - 1.0);
    return std::sqrt(variance / static_cast<double>(sum.size()) / count) / draw_size;
}

/// Returns the sum of squares about the mean.
double energy(std::span<const double> values) {
    const double mean = mean_of(values);
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return squares;
}

/// The record scaled for the decomposition, and the scale back to its unit.
class Preparation {
public:
    Preparation(std::span<const double> signal, const Options& options) {
        validate(options);
        exponent = common_exponent(signal);
        for (const double value : signal) scaled_.push_back(std::ldexp(value, -exponent));
        const std::size_t n = signal.size();
        plan.noise_level = options.noise_ratio * standard_deviation(scaled_);
        plan.residue_origin = mean_of(scaled_);
        plan.margin = options.reflect_ends ? n / 2 : 0;
        if (plan.margin > 0) scaled_ = reflected(scaled_, plan.margin);
        plan.signal = scaled_;
        plan.members = plan.noise_level > 0.0 ? options.ensemble_size : 1;
        plan.pairs = plan.noise_level > 0.0 && options.complementary_pairs;
        plan.mode_count =
            static_cast<std::size_t>(options.mode_count.value_or(default_mode_count(n)));
        plan.sifting = {options.stopping, options.finish, options.ends};
        plan.seed = options.seed;
    }
    Preparation(const Preparation&) = delete;  // the plan refers to this object's record
    Preparation& operator=(const Preparation&) = delete;

    /// Returns the ensemble mean of a sum over the members, not yet in the unit of the record.
    [[nodiscard]] std::vector<double> mean(std::span<const double> sum) const {
        std::vector<double> values(sum.begin(), sum.end());
        for (double& value : values) value /= plan.members;
        return values;
    }
    void restore_unit(std::span<double> values) const {
        for (double& value : values) value = std::ldexp(value, exponent);
    }

    int exponent = 0;
    EnsemblePlan plan;

private:
    std::vector<double> scaled_;
};

}  // namespace

int default_mode_count(std::size_t n) noexcept {
    return std::max(0, static_cast<int>(std::bit_width(n)) - 2);
}

Result eemd(std::span<const double> signal, const Options& options) {
    const Preparation prepared(signal, options);
    const EnsemblePlan& plan = prepared.plan;
    const std::size_t n = signal.size();
    const EnsembleSums sums = sum_ensemble(plan, options.threads, options.progress);

    const int draw_size = plan.pairs ? 2 : 1;
    const auto component = [&](std::size_t k, double origin) {
        const auto sum = std::span(sums.values).subspan(k * n, n);
        Component out;
        out.values = prepared.mean(sum);
        out.energy_share = energy(out.values);  // divided by the total below
        prepared.restore_unit(out.values);
        out.extrema_count = count_extrema(out.values);
        out.mean_period_samples =
            out.extrema_count == 0
                ? std::numeric_limits<double>::infinity()
                : 2.0 * static_cast<double>(n) / static_cast<double>(out.extrema_count);
        out.standard_error = standard_error(sum, sums.squares[k], draw_size * origin,
                                            plan.members / draw_size, draw_size);
        if (out.standard_error)
            *out.standard_error = std::ldexp(*out.standard_error, prepared.exponent);
        return out;
    };
    Result result;
    for (std::size_t k = 0; k < plan.mode_count; ++k) result.modes.push_back(component(k, 0.0));
    result.residue = component(plan.mode_count, plan.residue_origin);
    double total_energy = result.residue.energy_share;
    for (const Component& mode : result.modes) total_energy += mode.energy_share;
    if (total_energy > 0.0) {
        for (Component& mode : result.modes) mode.energy_share /= total_energy;
        result.residue.energy_share /= total_energy;
    }
    result.noise_level = std::ldexp(plan.noise_level, prepared.exponent);
    return result;
}

Trend eemd_trend(std::span<const double> signal, std::size_t most_extrema, const Options& options) {
    const Preparation prepared(signal, options);
    EnsemblePlan plan = prepared.plan;
    std::vector<double> left(static_cast<std::size_t>(plan.members) * plan.signal.size());
    plan.left = left;
    plan.mode_count = 0;
    Trend trend;
    for (;; ++trend.removed_modes) {
        const EnsembleSums sums = sum_ensemble(plan, options.threads, options.progress);
        trend.values = prepared.mean(sums.values);
        prepared.restore_unit(trend.values);
        const bool is_slow = count_extrema(trend.values) <= most_extrema;
        if (is_slow || trend.removed_modes == static_cast<int>(prepared.plan.mode_count)) break;
        plan.continues = true;
        plan.mode_count = 1;
    }
    return trend;
}

}  // namespace a351::corrector::eemd
