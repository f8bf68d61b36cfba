#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "corrector/long_record/response.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/signal/fourier.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/signal/regression.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::long_record {
namespace {

using Complex = std::complex<double>;
using Series = std::span<const Complex>;
constexpr double kCyclesPerBlock = 3.0;  // blocks with fewer cycles are not independent
constexpr std::size_t kFewestBlocks = 4, kMostBlocks = 24;

/// Sums over a block of acceleration and temperature, each times the conjugate of the mode.
using Sums = Eigen::Vector2cd;

Complex response_of(const Sums& sums) { return sums(0) / sums(1); }

/// Returns the period (s) of the mean frequency of a mode's power; 0 for a constant.
double period_of(std::span<const double> mode, double step_s) {
    const std::size_t length = signal::fast_length(mode.size());
    const signal::Spectrum spectrum = signal::half_spectrum(mode, length);
    double power = 0.0, frequency = 0.0;
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
        power += std::norm(spectrum[k]);
        frequency += std::norm(spectrum[k]) * static_cast<double>(k);
    }
    return frequency > 0.0 ? static_cast<double>(length) * step_s * power / frequency : 0.0;
}

std::vector<Sums> sums_of_blocks(Series mode, Series temperature, Series acceleration,
                                 std::size_t blocks) {
    std::vector<Sums> sums(blocks, Sums::Zero());
    for (std::size_t i = 0; i < mode.size(); ++i) {
        const Complex z = std::conj(mode[i]);
        sums[i * blocks / mode.size()] += Sums(acceleration[i] * z, temperature[i] * z);
    }
    return sums;
}

/// Returns the gain (mGal/degC) that chance exceeds with the probability p = kSignificance.
///
/// The rest a - H T of the acceleration is shifted around the record 40 times, and each shift gives
/// a gain without a cause.  With s the rms of these gains and f independent shifts:
///
///     gain^2 = s^2 f (p^(-1/f) - 1)
///
/// Reason: |gain|^2 / s^2 has the distribution F(2, 2 f), of which this is the quantile.  f is half
/// the number of cycles in the record, at most 40.
double chance_gain(Series mode, Series temperature, Series acceleration, Complex gain,
                   double cycles) {
    constexpr std::size_t kShifts = 40;
    const std::size_t count = mode.size();
    signal::Spectrum rest(count);
    double power = 0.0, square = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        rest[i] = acceleration[i] - gain * temperature[i];
        power += std::norm(mode[i]);
    }
    for (std::size_t k = 1; k <= kShifts; ++k) {
        const std::size_t shift = k * count / (kShifts + 1);
        Complex sum = 0.0;
        for (std::size_t i = 0; i < count; ++i)
            sum += rest[(i + shift) % count] * std::conj(mode[i]);
        square += std::norm(sum / power) / static_cast<double>(kShifts);
    }
    const double freedom = std::min(static_cast<double>(kShifts), cycles / 2.0);
    return std::sqrt(square * freedom * (std::pow(kSignificance, -1.0 / freedom) - 1.0));
}

/// Sets gain, phase and their limits: the wider of jackknife and chance.
/// @param sums    sums of all blocks; `all` is their sum.
/// @param chance  chance_gain()
/// @return true if the limits exclude half and twice the gain.
bool set_limits(ResponsePoint& point, const std::vector<Sums>& sums, const Sums& all, Complex gain,
                double chance) {
    const auto blocks = static_cast<double>(sums.size());
    Complex mean = 0.0;
    std::vector<Complex> deviations;
    for (const Sums& block : sums) deviations.push_back(std::log(response_of(all - block) / gain));
    for (const Complex& deviation : deviations) mean += deviation / blocks;
    double along = 0.0, across = 0.0;
    for (const Complex& deviation : deviations) {
        along += std::pow((deviation - mean).real(), 2);
        across += std::pow((deviation - mean).imag(), 2);
    }
    // Jackknife variance of ln H: (B - 1) / B sum of (deviation - mean)^2
    const double share = (blocks - 1.0) / blocks;
    const double quantile = signal::students_t_quantile(blocks - 1.0, 1.0 - 0.5 * kSignificance);
    const double factor = std::exp(quantile * std::sqrt(share * along));
    const double size = std::abs(gain), phase = std::arg(gain) * kDegPerRad;
    const double of_chance = chance < size ? std::asin(chance / size) * kDegPerRad : 180.0;
    const double half_width =
        std::clamp(quantile * std::sqrt(share * across) * kDegPerRad, of_chance, 180.0);
    point.gain = {size, std::max(0.0, std::min(size / factor, size - chance)),
                  std::max(size * factor, size + chance)};
    point.phase_deg = {phase, phase - half_width, phase + half_width};
    constexpr double kMostFactor = 2.0;
    return factor < kMostFactor && chance * kMostFactor < size;
}

/// Returns |sum y x*|^2 / (sum |x|^2 sum |y|^2); 0 for a constant.
double squared_correlation(Series x, Series y) {
    Complex xy = 0.0;
    double xx = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xy += y[i] * std::conj(x[i]);
        xx += std::norm(x[i]);
        yy += std::norm(y[i]);
    }
    return xx > 0.0 && yy > 0.0 ? std::norm(xy) / (xx * yy) : 0.0;
}

}  // namespace

std::vector<ResponsePoint> response_by_modes(const std::vector<std::vector<double>>& modes,
                                             std::span<const double> temperature_degc,
                                             std::span<const double> acceleration_mgal,
                                             double step_s) {
    const signal::Spectrum temperature =
        signal::analytic_signal(signal::without_line(temperature_degc));
    const signal::Spectrum acceleration =
        signal::analytic_signal(signal::without_line(acceleration_mgal));
    const double record_s = static_cast<double>(temperature_degc.size()) * step_s;
    std::vector<ResponsePoint> points;
    for (const std::vector<double>& mode : modes) {
        const double period_s = period_of(mode, step_s);
        if (period_s < kShortestResponse_s) continue;
        ResponsePoint& point = points.emplace_back();
        point.period_s = period_s;
        point.shortest_s = point.period_s / std::numbers::sqrt2;
        point.longest_s = point.period_s * std::numbers::sqrt2;
        point.temperature_rms_degc = std::sqrt(signal::variance_of(mode));
        const auto margin = static_cast<std::size_t>(0.5 * point.period_s / step_s);
        const double cycles = record_s / point.period_s;
        const auto blocks = std::min(
            static_cast<std::size_t>(std::max(0.0, cycles - 1.0) / kCyclesPerBlock), kMostBlocks);
        if (blocks < kFewestBlocks) {
            constexpr double kNeeded = kCyclesPerBlock * static_cast<double>(kFewestBlocks) + 1.0;
            point.refusal = text::message("fewer than {} cycles", text::fixed(kNeeded, 0));
            point.needed = text::message(
                "a record of {} h",
                text::fixed(std::ceil(kNeeded * point.period_s / kSecondsPerHour), 0));
            continue;
        }
        // Half a period at either end is left out, where the analytic signals are wrong.
        const auto inner = [margin](Series whole) {
            return whole.subspan(margin, whole.size() - 2 * margin);
        };
        const signal::Spectrum analytic = signal::analytic_signal(mode);
        const Series z = inner(analytic), t = inner(temperature), a = inner(acceleration);
        const auto sums = sums_of_blocks(z, t, a, blocks);
        point.coherence = squared_correlation(z, a);
        Sums all = Sums::Zero();
        for (const Sums& block : sums) all += block;
        const Complex gain = response_of(all);
        const double chance = chance_gain(z, t, a, gain, cycles);
        if (!std::isnormal(std::abs(gain)) || !std::isfinite(chance)) {
            point.refusal = text::message("temperature or acceleration is constant");
            point.needed = text::message("a record in which both vary");
        } else if (!set_limits(point, sums, all, gain, chance)) {
            point.refusal = text::message("not known within a factor of two");
            point.needed = text::message(
                "a larger temperature swing or a longer record; here no response below {} "
                "mGal/degC can be detected",
                text::fixed(2.0 * chance, 0));
        }
    }
    return points;
}

}  // namespace a351::corrector::long_record
