#pragma once
/// @file
/// Made-up records of occupations.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "corrector/reading/representative_value.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/white_noise.hpp"

namespace a351::corrector::reading {

inline constexpr double kGalPerStandardGravity = 980.665;
inline const UtcTime kSiteStart = UtcTime{std::chrono::seconds(1'500'160'000)};

/// Returns `level_g` plus a sine of `rms_gal` at `frequency_hz`, sampled at 50 Hz.
inline TimeSeries<StandardGravity> vibrating_axis(std::size_t n, double level_g, double rms_gal,
                                                  double frequency_hz) {
    std::vector<double> values(n, level_g);
    for (std::size_t i = 0; i < n; ++i) {
        values[i] +=
            std::numbers::sqrt2 * rms_gal / kGalPerStandardGravity *
            std::sin(2.0 * std::numbers::pi * frequency_hz * static_cast<double>(i) / 50.0);
    }
    return {kSiteStart, Hertz(50.0), std::move(values)};
}

/// Returns a record at 50 Hz: a vertical axis of `level(seconds)` mGal with white noise, horizontal
/// axes with noise only, and a temperature of `temperature(seconds)` from `lead_s` before the
/// occupation to `lead_s` after it.
template <class Level, class Temperature>
OccupationRecord make_record(double seconds, Level level, Temperature temperature,
                             double noise_mgal = 0.0, double lead_s = 0.0) {
    const auto n = static_cast<std::size_t>(std::lround(seconds * 50.0));
    const auto lead = static_cast<std::size_t>(std::lround(lead_s * 50.0));
    const auto axis = [&](std::uint64_t member, auto value_mgal) {
        std::vector<double> values(n);
        eemd::fill_white_noise(1, member, values);
        for (std::size_t i = 0; i < n; ++i) {
            values[i] = (noise_mgal * values[i] + value_mgal(static_cast<double>(i) / 50.0)) /
                        kMilliGalPerStandardGravity;
        }
        return TimeSeries<StandardGravity>(kSiteStart, Hertz(50.0), std::move(values));
    };
    std::vector<double> degc(n + 2 * lead);
    for (std::size_t i = 0; i < degc.size(); ++i)
        degc[i] = temperature((static_cast<double>(i) - static_cast<double>(lead)) / 50.0);
    const auto zero = [](double) { return 0.0; };
    return {axis(0, zero), axis(1, zero), axis(2, level),
            TimeSeries<DegC>(kSiteStart - from_seconds(lead_s), Hertz(50.0), std::move(degc))};
}

inline std::optional<RepresentativeValue> value_of(const OccupationRecord& record,
                                                   const RepresentativeOptions& options = {}) {
    return representative_value(record, decimate_axes(record), options);
}

/// Returns the same series with the samples first ... last missing.
template <class Unit>
TimeSeries<Unit> without(const TimeSeries<Unit>& series, std::size_t first, std::size_t last) {
    std::vector<double> values = series.values();
    for (std::size_t i = first; i <= last; ++i) values[i] = std::nan("");
    return {series.start(), series.rate(), std::move(values)};
}

}  // namespace a351::corrector::reading
