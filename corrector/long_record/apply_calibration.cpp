#include "corrector/long_record/apply_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "protocol/core/units.hpp"
#include "protocol/signal/fourier.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/signal/regression.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/unit/combined_estimates.hpp"

namespace a351::corrector::long_record {
namespace {

// Half width of the smoothing window, samples.  15 samples of 20 s reduce white noise to 0.39 and
// keep 99 % of a cycle of 15 min.
constexpr std::size_t kHalfWindow = 7;
constexpr double kShortestPeriod_s = 39.0;  // two steps, with a margin for the sensor's clock
constexpr double kLeastRatioToError = 2.0;  // least ratio of a part to its error to be applied

/// Returns the response with the parameters that are applied; the others are 0.
unit::ThermalEffect effect_of(const unit::ThermalResponse& thermal,
                              std::vector<text::Message>& remarks) {
    const auto [values, covariance] = unit::combined(std::vector{thermal, unit::record_priors()});

    unit::ThermalEffect response;
    response.fast_lag_s = std::exp(values(3));
    response.slow_lag_s = std::exp(values(4));
    const double slope = values(0) + values(1);
    const double slope_error =
        std::sqrt(covariance(0, 0) + covariance(1, 1) + 2.0 * covariance(0, 1));
    const double rate_error = std::sqrt(covariance(2, 2));
    const auto left_out = [&remarks](const char* name, double value, double error,
                                     const char* unit) {
        remarks.push_back(text::message(
            "the calibration does not determine the {} ({} +- {} {}): it was not applied",
            text::marked_message(name), text::fixed(value, 1), text::fixed(error, 1), unit));
    };
    if (std::abs(slope) >= kLeastRatioToError * slope_error) {
        response.level = values(0);
        response.slow = values(1);
    } else {
        left_out(text::marked("static slope"), slope, slope_error, "mGal/degC");
    }
    if (std::abs(values(2)) >= kLeastRatioToError * rate_error)
        response.fast = values(2);
    else
        left_out(text::marked("fast path"), values(2), rate_error, "mGal/(degC/h)");
    return response;
}

/// Smooths by a local parabola over the part of the window that is inside on both sides.  The
/// weight at the place j of a window of 2 h + 1 samples is proportional to 3 h^2 + 3 h - 1 - 5 j^2.
/// Source: A. Savitzky and M. J. E. Golay, Anal. Chem. 36, 1627-1639, 1964.
std::vector<double> smoothed(const std::vector<double>& values) {
    std::vector<double> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t half = std::min({kHalfWindow, i, values.size() - 1 - i});
        const double h = static_cast<double>(half);
        double sum = 0.0, weights = 0.0;
        for (std::size_t j = 0; j <= 2 * half; ++j) {
            const double place = static_cast<double>(j) - h;
            const double weight =
                half == 0 ? 1.0 : 3.0 * h * h + 3.0 * h - 1.0 - 5.0 * place * place;
            sum += weight * values[i - half + j];
            weights += weight;
        }
        result[i] = sum / weights;
    }
    return result;
}

std::vector<double> by_two_paths(const RecordSegment& segment, const unit::ThermalEffect& response,
                                 double step_s) {
    const std::vector<double> temperature = smoothed(segment.temperature_degc);
    const TimeSeries<DegC> series({}, Hertz(1.0 / step_s), temperature);
    const std::vector<double> effect = response.of(series, signal::mean_of(temperature));
    std::vector<double> corrected = segment.quantity;
    for (std::size_t i = 0; i < corrected.size(); ++i) corrected[i] -= effect[i];
    return corrected;
}

bool is_short(const eemd::Component& mode, double step_s, double averaged_below_s) {
    return mode.mean_period_samples * step_s < averaged_below_s;
}

std::vector<double> mode_by_mode(const RecordSegment& segment, const RecordAnalysis& analysis,
                                 const unit::ThermalEffect& response, double averaged_below_s) {
    const double step_s = analysis.step_s;
    std::vector<double> corrected = segment.quantity;
    for (const eemd::Component& mode : analysis.acceleration.modes) {
        if (!is_short(mode, step_s, averaged_below_s)) continue;
        for (std::size_t i = 0; i < corrected.size(); ++i) corrected[i] -= mode.values[i];
    }
    const double slope = response.level + response.slow;
    const auto subtract_slow = [&](const eemd::Component& component) {
        const double mean = signal::mean_of(component.values);
        for (std::size_t i = 0; i < corrected.size(); ++i)
            corrected[i] -= slope * (component.values[i] - mean);
    };
    for (const eemd::Component& mode : analysis.temperature.modes) {
        if (is_short(mode, step_s, averaged_below_s)) continue;
        if (!std::isfinite(mode.mean_period_samples)) {
            subtract_slow(mode);
            continue;
        }
        const signal::Spectrum turned = signal::analytic_signal(mode.values);
        const std::complex<double> gain = response.at(mode.mean_period_samples * step_s);
        for (std::size_t i = 0; i < corrected.size(); ++i)
            corrected[i] -= (gain * turned[i]).real();
    }
    subtract_slow(analysis.temperature.residue);
    return corrected;
}

/// Returns the mean square of the values in each band of periods, without their straight line.
std::vector<double> band_squares(const std::vector<double>& values, double step_s,
                                 const std::vector<double>& edges_s) {
    const std::vector<double> centred = signal::without_line(values);
    const std::size_t length = signal::fast_length(centred.size());
    const signal::Spectrum spectrum = signal::half_spectrum(centred, length);
    std::vector<double> squares(edges_s.size() - 1, 0.0);
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
        const double period_s = static_cast<double>(length) * step_s / static_cast<double>(k);
        const auto above = std::upper_bound(edges_s.begin(), edges_s.end(), period_s);
        if (above == edges_s.begin() || above == edges_s.end()) continue;
        squares[static_cast<std::size_t>(above - edges_s.begin()) - 1] +=
            2.0 * std::norm(spectrum[k]) /
            (static_cast<double>(length) * static_cast<double>(centred.size()));
    }
    return squares;
}

}  // namespace

AppliedCalibration apply_calibration(const unit::ThermalResponse& thermal,
                                     const RecordSegment& segment, const RecordAnalysis& analysis,
                                     double averaged_below_s) {
    AppliedCalibration applied;
    const unit::ThermalEffect response = effect_of(thermal, applied.remarks);
    applied.averaged_below_s = averaged_below_s;
    applied.parametric_mgal = by_two_paths(segment, response, analysis.step_s);
    applied.by_modes_mgal = mode_by_mode(segment, analysis, response, averaged_below_s);

    const std::array<const std::vector<double>*, 3> series{
        &segment.quantity, &applied.parametric_mgal, &applied.by_modes_mgal};
    const std::vector<double> edges_s{kShortestPeriod_s, 240.0,   600.0, 1500.0, 3600.0,
                                      10800.0,           HUGE_VAL};
    std::array<std::vector<double>, 3> squares;
    for (std::size_t k = 0; k < series.size(); ++k)
        squares.at(k) = band_squares(*series.at(k), analysis.step_s, edges_s);
    for (std::size_t band = 0; band + 1 < edges_s.size(); ++band)
        applied.bands.push_back({edges_s[band],
                                 edges_s[band + 1],
                                 {std::sqrt(squares[0][band]), std::sqrt(squares[1][band]),
                                  std::sqrt(squares[2][band])}});
    for (std::size_t samples = 1; samples <= segment.size() / 4; samples *= 2)
        applied.allan.push_back({static_cast<double>(samples) * analysis.step_s,
                                 {noise::allan_deviation(*series[0], samples),
                                  noise::allan_deviation(*series[1], samples),
                                  noise::allan_deviation(*series[2], samples)}});
    return applied;
}

}  // namespace a351::corrector::long_record
