#pragma once
/// @file
/// One occupation's 50 Hz record -> the value that stands for it, with what is needed to judge it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "corrector/reading/decimated_axes.hpp"
#include "corrector/reading/interval_statistics.hpp"
#include "corrector/reading/trend_curve.hpp"
#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Of the smoother's cut-off.  Shorter is no trend; longer than an occupation's waves it bends them,
/// and at 10 Hz its samples would be too many.
inline constexpr double kShortestCutoff_s = 20.0;
inline constexpr double kLongestCutoff_s = 500.0;

struct RepresentativeOptions {
    NormOrder norm = NormOrder::decimate_first;
    TrendMethod trend = TrendMethod::eemd;
    TrendCurve curve = TrendCurve::slow;  ///< Of the decomposition.
    double cutoff_s = 300.0;              ///< Of the smoother; decimation.md says why so long.
    double end_margin_s = 60.0;           ///< So far from an end a disturbance belongs to it, >= 0.
    double disturbance_threshold = 8.0;   ///< find_disturbances(), > 0.
    /// Whether disturbed samples next to the ends give way to the running median (despike()) before
    /// the decomposition, which else spreads them over all components; false: as published.
    bool despike = true;
    std::uint64_t seed = 0;  ///< Of the noise of the decomposition.
    int threads = 1;         ///< For the decomposition; no effect on the result.
};

/// Doubts about an occupation, in this order.
enum class OccupationFlag {
    fallback,         ///< The interval's first rule did not apply.
    disturbed_start,  ///< The interval begins after a disturbance.
    disturbed_end,    ///< The interval ends before a disturbance.
    pulse,            ///< A disturbance inside cut the record; the longer part was used.
    gap,              ///< Samples are missing within the occupation.
    no_temperature,   ///< Fewer than two valid temperatures in the interval.
    unsettled,        ///< The value is the smoother's, whose weights did not settle.
};

/// The flag's name in tables: as in the enumeration.
[[nodiscard]] std::string_view flag_name(OccupationFlag flag) noexcept;

/// Decimated samples of an occupation, by the raw samples under both filters.
struct SampleCounts {
    std::size_t valid = 0;    ///< All are there.
    std::size_t partial = 0;  ///< Some are missing, or beyond either end.
    std::size_t missing = 0;  ///< None is there.
};

struct RepresentativeValue {
    MilliGal acceleration;                          ///< Mean of `curve` over the interval.
    MilliGal eemd_mean;                             ///< Mean of the decomposition's trend over it.
    MilliGal smoother_mean;                         ///< Mean of the smoother's trend over it.
    MilliGal smoother_standard_error;               ///< Of smoother_mean, for white noise.
    MilliGal series_mean;                           ///< Mean of `series` over the interval.
    std::optional<MilliGal> standard_error;         ///< Of series_mean, from blocks of 60 s.
    std::optional<TemperatureSummary> temperature;  ///< Of the decimated temperature.
    UtcTime interval_start;                         ///< First sample of the interval.
    UtcTime interval_end;                           ///< Last sample of the interval.
    std::vector<OccupationFlag> flags;              ///< Ascending.
    SampleCounts counts;
    AxisSummary x, y, z;     ///< Over the interval.
    MilliGal rectification;  ///< rectification_bias(): in the value if NormOrder::as_published.
    MilliGal noise_level;    ///< Std. deviation of the noise the decomposition added.
    TimeSeries<MilliGal> series;  ///< Decimated norm of the whole record, at 1 / 100 of its rate.
    TimeSeries<MilliGal> curve;   ///< Trend of the part that was decomposed, as asked for.
    TimeSeries<DegC> temperature_series;  ///< Decimated temperature, at the instants of `series`.
};

/// Decimates twice by 10, takes the longest run of valid samples and of it the longest part between
/// pulses, decomposes that (EEMD of 80 members, noise ratio 0.1, ten sifts) and smooths it, chooses the
/// interval by the trend curve and averages both curves over it.
///
/// @param axes  decimate_axes(record).
/// @return std::nullopt when that part has fewer than 16 samples (32 s at 50 Hz): too short.
/// @throws std::invalid_argument  the axes, or axes and temperature, are not on one grid; an option
///                                is out of range.
/// Method: S. Matsuda, K. Nakasendo, H. Morikawa, K. Iiyama and K. Sakai, "An experimental study on
/// basic performances of accelerometer with crystal oscillator" (in Japanese).  Departs from it by
/// default in the order of norm and decimation, in the trend curve and in its mirrored ends (eemd.md).
[[nodiscard]] std::optional<RepresentativeValue> representative_value(
    const OccupationRecord& record, const DecimatedAxes& axes,
    const RepresentativeOptions& options = {});

}  // namespace a351::corrector
