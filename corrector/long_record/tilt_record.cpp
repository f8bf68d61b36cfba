#include "corrector/long_record/tilt_record.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "corrector/archive_series/tilt.hpp"
#include "corrector/noise/spectral_density.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/signal/fourier.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/signal/regression.hpp"

namespace a351::corrector::long_record {
namespace {

/// Spectra of temperature and tilt of a segment, without their straight lines and under a Hann window,
/// at the frequencies that are used.  Without the window the slow part of both leaks into all
/// frequencies, so that these do not tell the slope independently.
struct Spectra {
    std::vector<double> frequencies_hz;
    signal::Spectrum degc, urad;
    double power_per_density = 0.0;  ///< Expected |urad|^2 for a one-sided density of 1 urad^2/Hz.
};

/// Shortest period, s, the same as for two paths: at shorter ones the thermometer shows its own noise.
constexpr double kShortestOfTilt_s = 240.0;
/// Mean square of the Hann window, and its mean fourth power divided by the square of this.  The
/// second is the number of neighbouring frequencies that contain the information of one.
constexpr double kHannSquare = 3.0 / 8.0, kHannShared = 35.0 / 18.0;

Spectra spectra_of(const RecordSegment& segment, double step_s) {
    std::size_t size = segment.size();
    while (signal::fast_length(size) != size) --size;
    const std::vector<double> window = noise::hann(size);
    const auto spectrum = [&](const std::vector<double>& values) {
        std::vector<double> rest = signal::without_line(std::span(values).first(size));
        for (std::size_t i = 0; i < size; ++i) rest[i] *= window[i];
        return signal::half_spectrum(rest, size);
    };
    const signal::Spectrum degc = spectrum(segment.temperature_degc),
                           urad = spectrum(segment.quantity);
    const double length_s = static_cast<double>(size) * step_s;
    Spectra spectra;
    spectra.power_per_density = kHannSquare * static_cast<double>(size) / (2.0 * step_s);
    for (std::size_t k = 1; static_cast<double>(k) * kShortestOfTilt_s <= length_s; ++k) {
        spectra.frequencies_hz.push_back(static_cast<double>(k) / length_s);
        spectra.degc.push_back(degc[k]);
        spectra.urad.push_back(urad[k]);
    }
    return spectra;
}

/// Sets the slope with the least sum of |residual|^2 / noise, and its error.
void set_slope(TiltFit& fit, const std::vector<Spectra>& segments) {
    double squares = 0.0, products = 0.0, all = 0.0, count = 0.0;
    for (const Spectra& spectra : segments)
        for (std::size_t k = 0; k < spectra.degc.size(); ++k) {
            const double weight =
                1.0 / (spectra.power_per_density *
                       fit.noise.noises.density_mgal2_per_hz(spectra.frequencies_hz[k]));
            squares += weight * std::norm(spectra.degc[k]);
            products += weight * (std::conj(spectra.degc[k]) * spectra.urad[k]).real();
            all += weight * std::norm(spectra.urad[k]);
            count += 1.0;
        }
    fit.slope_urad_per_degc = products / squares;
    fit.misfit = std::sqrt((all - products * fit.slope_urad_per_degc) / (count - 0.5));
    // |residual|^2 is the sum of two squares, so that the information is twice that of one.
    fit.slope_error_urad_per_degc =
        std::max(1.0, fit.misfit) * std::sqrt(kHannShared / (2.0 * squares));
}

}  // namespace

double TiltFit::u_urad(double degc) const {
    return std::hypot(noise.points.front().deviation_mgal.value,
                      slope_error_urad_per_degc * (degc - temperature_degc));
}

LongRecord tilt_record(LongRecord record, std::size_t axis) {
    std::vector<double> finite;
    for (RecordStretch& stretch : record.stretches) {
        if (stretch.axes_mgal.empty())
            throw InputError(
                "--quantity: the record has the norm only; allowed: a tilt of records with the "
                "axes "
                "x_g, y_g, z_g or an archive in every part");
        for (std::size_t i = 0; i < stretch.size(); ++i) {
            double& tilt = stretch.quantity[i];
            tilt = archive_series::tilt_urad(
                {stretch.axes_mgal[0][i], stretch.axes_mgal[1][i], stretch.axes_mgal[2][i]}, axis);
            if (std::isfinite(tilt)) finite.push_back(tilt);
        }
        stretch.raw.clear();
    }
    archive_series::require_horizontal(std::move(finite), axis, "--quantity");
    record.unit = "urad";
    record.is_tide_removed = false;
    return record;
}

TiltFit fit_tilt(const RecordSegments& parts, double step_s, std::size_t axis) {
    TiltFit fit;
    fit.axis = axis;
    std::vector<double> all_degc;
    for (const RecordSegment& segment : parts.segments)
        all_degc.insert(all_degc.end(), segment.temperature_degc.begin(),
                        segment.temperature_degc.end());
    fit.temperature_degc = signal::mean_of(all_degc);
    const auto longest = std::ranges::max_element(parts.segments, {}, &RecordSegment::size);
    std::vector<Spectra> segments;
    for (const RecordSegment& segment : parts.segments)
        segments.push_back(spectra_of(segment, step_s));
    constexpr int kRounds = 3;  // the third changes the slope by less than a hundredth of its error
    for (int round = 0; round < kRounds; ++round) {
        std::vector<double> rest = longest->quantity;
        for (std::size_t i = 0; i < rest.size(); ++i)
            rest[i] = fit.corrected_urad(rest[i], longest->temperature_degc[i]);
        fit.noise = noise::analyse_allan(rest, step_s);
        set_slope(fit, segments);
    }
    return fit;
}

}  // namespace a351::corrector::long_record
