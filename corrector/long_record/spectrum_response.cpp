#include <algorithm>
#include <cmath>
#include <numbers>

#include "corrector/long_record/response.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/fourier.hpp"
#include "protocol/signal/regression.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::long_record {
namespace {

constexpr std::size_t kFewestTapers = 3, kMostTapers = 15;
constexpr double kHalfOctave = std::numbers::sqrt2;
constexpr double kNoiseShare = 0.2;    // largest share of the thermometer's noise in the power
constexpr double kFewestCycles = 6.0;  // cycles of a period that the record must contain

/// Spectra of both series with each taper; white noise of variance 1 has the mean square 1.
struct TaperedSpectra {
    std::vector<signal::Spectrum> temperature, acceleration;
    double bin_hz = 0.0;    ///< Distance of the frequencies.
    double rayleigh = 0.0;  ///< Number of values within the resolution of the untapered record.

    [[nodiscard]] std::size_t size() const { return temperature.front().size(); }
};

TaperedSpectra tapered_spectra(std::span<const double> temperature,
                               std::span<const double> acceleration, double step_s) {
    const std::size_t count = temperature.size();
    const std::size_t length = signal::fast_length(count);
    const std::vector<double> t = signal::without_line(temperature),
                              a = signal::without_line(acceleration);
    TaperedSpectra result;
    result.bin_hz = 1.0 / (static_cast<double>(length) * step_s);
    result.rayleigh = static_cast<double>(length) / static_cast<double>(count);
    std::vector<double> tapered_t(count), tapered_a(count);
    const auto n1 = static_cast<double>(count + 1);
    for (std::size_t taper = 1; taper <= kMostTapers; ++taper) {
        const double angle = std::numbers::pi * static_cast<double>(taper) / n1;
        for (std::size_t i = 0; i < count; ++i) {
            // w_k(i) = sqrt(2 / (n + 1)) sin(pi k i / (n + 1)), i = 1 ... n
            // (Riedel and Sidorenko 1995)
            const double weight =
                std::sqrt(2.0 / n1) * std::sin(angle * static_cast<double>(i + 1));
            tapered_t[i] = weight * t[i];
            tapered_a[i] = weight * a[i];
        }
        result.temperature.push_back(signal::half_spectrum(tapered_t, length));
        result.acceleration.push_back(signal::half_spectrum(tapered_a, length));
    }
    return result;
}

/// A band of periods and its frequencies [first, end).
struct Band {
    double shortest_s, longest_s;
    std::size_t first, end;
};

std::vector<Band> bands_of(const TaperedSpectra& spectrum, double step_s, double cycle_s) {
    std::vector<Band> bands;
    const auto number = [&](double period_s) {
        return static_cast<std::size_t>(std::ceil(1.0 / (period_s * spectrum.bin_hz)));
    };
    double period_s = cycle_s;
    while (period_s / kHalfOctave > std::max(kShortestResponse_s, 4.0 * step_s))
        period_s /= kHalfOctave;
    const double quarter = std::sqrt(kHalfOctave);
    for (; period_s * spectrum.bin_hz < 1.0; period_s *= kHalfOctave) {
        const Band band{period_s / quarter, period_s * quarter,
                        std::max<std::size_t>(1, number(period_s * quarter)),
                        std::min(spectrum.size(), number(period_s / quarter))};
        if (band.first < band.end) bands.push_back(band);
    }
    return bands;
}

/// Returns the white noise of the thermometer, degC^2: the mean power of the temperature, at periods
/// where an oven hardly acts, that the acceleration does not follow.
double thermometer_noise(const TaperedSpectra& spectrum) {
    constexpr double kLongest_s = 110.0, kShortest_s = 70.0;  // the edge of the filters is at 40 s
    double tt = 0.0, aa = 0.0, count = 0.0;
    std::complex<double> at = 0.0;
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
        const double period_s = 1.0 / (static_cast<double>(k) * spectrum.bin_hz);
        if (period_s > kLongest_s || period_s < kShortest_s) continue;
        const std::complex<double> x = spectrum.temperature.front()[k],
                                   y = spectrum.acceleration.front()[k];
        tt += std::norm(x);
        aa += std::norm(y);
        at += y * std::conj(x);
        count += 1.0;
    }
    // N = (S_TT - |S_aT|^2 / S_aa) n / (n - 1)
    if (!(aa > 0.0) || count < 2.0) return count > 0.0 ? tt / count : 0.0;
    return std::max(0.0, tt - std::norm(at) / aa) / (count - 1.0);
}

ResponsePoint response_in(const Band& band, const TaperedSpectra& spectrum, double noise,
                          double record_s, std::size_t samples, double significance) {
    double tt = 0.0, aa = 0.0, tt2 = 0.0, frequency = 0.0;
    std::complex<double> at = 0.0;
    // The main lobe of K tapers is K + 1 resolutions wide.
    const double cycles = record_s / std::sqrt(band.shortest_s * band.longest_s);
    constexpr double kRelativeWidth = 0.348;  // width of half an octave, share of its middle
    const auto tapers = std::clamp(static_cast<std::size_t>(0.5 * kRelativeWidth * cycles),
                                   kFewestTapers + 1, kMostTapers + 1) -
                        1;
    for (std::size_t k = band.first; k < band.end; ++k) {
        double power = 0.0;
        for (std::size_t taper = 0; taper < tapers; ++taper) {
            const std::complex<double> x = spectrum.temperature[taper][k],
                                       y = spectrum.acceleration[taper][k];
            power += std::norm(x) / static_cast<double>(tapers);
            aa += std::norm(y) / static_cast<double>(tapers);
            at += y * std::conj(x) / static_cast<double>(tapers);
        }
        tt += power;
        tt2 += power * power;
        frequency += (power - noise) * static_cast<double>(k) * spectrum.bin_hz;
    }
    const auto bins = static_cast<double>(band.end - band.first);
    const bool is_noise = noise * bins > kNoiseShare * tt;
    const double of_oven = tt - noise * bins;  // S_TT without the thermometer's noise
    ResponsePoint point;
    point.shortest_s = band.shortest_s;
    point.longest_s = band.longest_s;
    point.period_s =
        tt > 0.0 && !is_noise ? of_oven / frequency : std::sqrt(band.shortest_s * band.longest_s);
    point.temperature_rms_degc =
        std::sqrt(2.0 * tt / spectrum.rayleigh / static_cast<double>(samples));
    // H = S_aT / (S_TT - N).  If the temperature is constant, S_TT is 0 or a rounding error, and H
    // can be infinite or NaN.
    const double s_tt = is_noise ? tt : of_oven;
    const std::complex<double> gain = at / s_tt;
    if (!(tt > 0.0) || !(aa > 0.0) || !std::isfinite(std::abs(gain)) || !std::isfinite(aa / tt)) {
        point.refusal = text::message("temperature or acceleration is constant");
        point.needed = text::message("a record in which both vary");
        return point;
    }
    // nu: resolutions filled by the temperature's power, minus one.  A line is as wide as the
    // tapers.
    const double freedom = std::max(tt * tt / tt2 / spectrum.rayleigh - 1.0, 2.0);
    point.coherence = std::min(1.0, std::norm(at) / tt / aa);  // rounding may exceed 1
    // Limits: |H - estimate|^2 <= (alpha^(-1 / (nu - 1)) - 1) (1 - coherence) S_aa S_TT / (S_TT - N)^2
    const double quantile = std::pow(significance, -1.0 / (freedom - 1.0 + 1e-9)) - 1.0;
    const double radius = std::sqrt(quantile * (1.0 - point.coherence) * aa * tt) / s_tt;
    point.gain = {std::abs(gain), std::max(0.0, std::abs(gain) - radius), std::abs(gain) + radius};
    const double phase = std::arg(gain) * kDegPerRad;
    const double half_width =
        radius < std::abs(gain) ? std::asin(radius / std::abs(gain)) * kDegPerRad : 180.0;
    point.phase_deg = {phase, phase - half_width, phase + half_width};

    const double least_swing_degc = std::sqrt(16.0 * noise * bins / kNoiseShare /
                                              spectrum.rayleigh / static_cast<double>(samples));
    if (point.period_s > record_s / kFewestCycles) {
        point.refusal = text::message("fewer than {} cycles", text::fixed(kFewestCycles, 0));
        point.needed = text::message(
            "a record of {} h",
            text::fixed(std::ceil(kFewestCycles * point.period_s / kSecondsPerHour), 0));
    } else if (is_noise) {
        point.refusal =
            text::message("no excitation: the temperature shows the thermometer's noise");
        point.needed = text::message("a swing of {} degC", text::fixed(least_swing_degc, 4));
    } else if (radius >= std::abs(gain)) {
        point.refusal = text::message("no coherence above chance");
        point.needed = text::message(
            "a larger temperature swing or a longer record; here no response below {} mGal/degC "
            "can be detected",
            text::fixed(point.gain.high, 0));
    }
    return point;
}

}  // namespace

ThermometerSpectrum thermometer_spectrum(std::span<const double> temperature_degc,
                                         std::span<const double> acceleration_mgal, double step_s) {
    constexpr std::size_t kTapers = 7;
    const TaperedSpectra spectrum = tapered_spectra(temperature_degc, acceleration_mgal, step_s);
    ThermometerSpectrum result;
    result.noise = thermometer_noise(spectrum);
    result.power.resize(spectrum.size());
    for (std::size_t taper = 0; taper < kTapers; ++taper)
        for (std::size_t k = 0; k < spectrum.size(); ++k)
            result.power[k] +=
                std::norm(spectrum.temperature[taper][k]) / static_cast<double>(kTapers);
    return result;
}

std::vector<ResponsePoint> response_by_spectrum(std::span<const double> temperature_degc,
                                                std::span<const double> acceleration_mgal,
                                                double step_s, const ResponseOptions& options) {
    const TaperedSpectra spectrum = tapered_spectra(temperature_degc, acceleration_mgal, step_s);
    const double noise = options.noise_degc2 ? *options.noise_degc2 : thermometer_noise(spectrum);
    const double record_s = static_cast<double>(temperature_degc.size()) * step_s;
    std::vector<ResponsePoint> points;
    const std::vector<Band> bands = bands_of(spectrum, step_s, options.cycle_s);
    const double significance =
        kSignificance / static_cast<double>(options.is_joint ? bands.size() : 1);
    for (const Band& band : bands)
        points.push_back(
            response_in(band, spectrum, noise, record_s, temperature_degc.size(), significance));
    return points;
}

}  // namespace a351::corrector::long_record
