#include "corrector/reading/representative_value.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "corrector/reading/disturbance.hpp"
#include "corrector/reading/interval.hpp"
#include "corrector/reading/smoother.hpp"
#include "protocol/signal/moments.hpp"

namespace a351::corrector::reading {
namespace {

constexpr std::size_t kShortestRun = 16;  // decimated samples, 32 s at 50 Hz
constexpr double kBlockSeconds = 60.0;    // blocks of the standard error

/// Largest distance from an end at which a disturbance belongs to this end; elsewhere it is a pulse.
/// Source: decimation.md, "Interval".
constexpr double kEndMargin_s = 60.0;

/// Returns the half-width of both decimation stages together, raw samples: 41 + 10 x 41 = 451.
std::size_t reach_of(const signal::DecimationFilter& filter) {
    return filter.half_width() * (1 + filter.factor);
}

std::size_t samples_in(double seconds, Hertz rate) {
    return static_cast<std::size_t>(std::lround(seconds * rate.value()));
}

struct Run {
    std::size_t begin = 0;
    std::size_t size = 0;
};

/// Returns the longest run without NaN; the earliest of several.
Run longest_valid_run(std::span<const double> values) {
    Run longest;
    Run current;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) {
            current = {i + 1, 0};
        } else if (++current.size > longest.size) {
            longest = current;
        }
    }
    return longest;
}

/// Returns present[i], the number of raw samples before i that have all three axes.
std::vector<std::size_t> count_present(const OccupationRecord& record) {
    std::vector<std::size_t> present(record.x.size() + 1);
    for (std::size_t i = 0; i < record.x.size(); ++i) {
        const double sum = record.x.values()[i] + record.y.values()[i] + record.z.values()[i];
        present[i + 1] = present[i] + (std::isfinite(sum) ? 1 : 0);
    }
    return present;
}

SampleCounts count_samples(const std::vector<std::size_t>& present, std::size_t output_count,
                           std::size_t reach) {
    const std::size_t n = present.size() - 1;
    SampleCounts counts;
    for (std::size_t k = 0; k < output_count; ++k) {
        const std::size_t centre = k * kDecimationRatio;
        const std::size_t begin = centre - std::min(centre, reach);
        const std::size_t end = std::min(n, centre + reach + 1);
        const std::size_t there = present[end] - present[begin];
        ++(there == 2 * reach + 1 ? counts.valid : there > 0 ? counts.partial : counts.missing);
    }
    return counts;
}

/// Returns the decimated temperature on the grid of the decimated axes.  Uses the temperature
/// recorded beyond the axes.
TimeSeries<DegC> decimate_temperature(const OccupationRecord& record,
                                      const signal::DecimationFilter& filter) {
    const TimeSeries<DegC>& all = record.temperature;
    if (all.rate() != record.x.rate())
        throw std::invalid_argument("representative_value: temperature and axes differ in rate");
    const double shift = seconds_between(all.start(), record.x.start()) * all.rate().value();
    if (std::abs(shift - std::round(shift)) > 0.01) {
        throw std::invalid_argument(
            "representative_value: temperature and axes are not on one grid of instants");
    }
    const std::size_t lead = (reach_of(filter) + kDecimationRatio - 1) / kDecimationRatio;
    const auto origin = static_cast<std::ptrdiff_t>(std::llround(shift)) -
                        static_cast<std::ptrdiff_t>(lead * kDecimationRatio);
    std::vector<double> around(record.x.size() + 2 * lead * kDecimationRatio,
                               std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < around.size(); ++i) {
        const std::ptrdiff_t source = origin + static_cast<std::ptrdiff_t>(i);
        if (source >= 0 && source < static_cast<std::ptrdiff_t>(all.size()))
            around[i] = all.values()[static_cast<std::size_t>(source)];
    }
    const TimeSeries<DegC> decimated =
        signal::decimate(TimeSeries<DegC>(record.x.start(), all.rate(), std::move(around)), filter,
                         kDecimationStages);
    const std::size_t count = (record.x.size() + kDecimationRatio - 1) / kDecimationRatio;
    const auto begin = decimated.values().begin() + static_cast<std::ptrdiff_t>(lead);
    return {record.x.start(), decimated.rate(),
            std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count))};
}

std::vector<OccupationFlag> flags_of(const Part& part, const Interval& interval, bool has_gap,
                                     bool has_temperature, bool is_settled) {
    std::vector<OccupationFlag> flags;
    const auto raise = [&](OccupationFlag flag, bool condition) {
        if (condition) flags.push_back(flag);
    };
    raise(OccupationFlag::fallback, interval.fallback);
    raise(OccupationFlag::disturbed_start, part.disturbed_first);
    raise(OccupationFlag::disturbed_end, part.disturbed_last);
    raise(OccupationFlag::pulse, part.split);
    raise(OccupationFlag::gap, has_gap);
    raise(OccupationFlag::no_temperature, !has_temperature);
    raise(OccupationFlag::unsettled, !is_settled);
    return flags;
}

}  // namespace

std::string_view flag_name(OccupationFlag flag) noexcept {
    constexpr std::array<std::string_view, 7> kNames{
        "fallback", "disturbed_start", "disturbed_end", "pulse",
        "gap",      "no_temperature",  "unsettled"};
    return kNames[static_cast<std::size_t>(flag)];
}

std::optional<RepresentativeValue> representative_value(const OccupationRecord& record,
                                                        const DecimatedAxes& axes,
                                                        const RepresentativeOptions& options) {
    if (!(options.cutoff_s >= kShortestCutoff_s && options.cutoff_s <= kLongestCutoff_s)) {
        throw std::invalid_argument(fmt::format(
            "representative_value: cutoff_s = {:f}, must be 20 to 500", options.cutoff_s));
    }
    const signal::DecimationFilter filter = signal::design_decimation(kDecimationFactor);
    TimeSeries<MilliGal> series = gravity_series(record, axes, options.norm);
    const TimeSeries<DegC> temperature = decimate_temperature(record, filter);
    const Run run = longest_valid_run(series.values());
    if (run.size < kShortestRun) return std::nullopt;
    const auto valid = std::span(series.values()).subspan(run.begin, run.size);
    const Disturbances found = find_disturbances(valid, kDisturbanceThreshold);
    const Part part = choose_part(found.disturbed, samples_in(kEndMargin_s, series.rate()));
    const std::size_t part_size = part.last - part.first + 1;
    if (part_size < kShortestRun) return std::nullopt;

    eemd::Options decomposition;
    decomposition.seed = options.seed;
    if (options.curve != TrendCurve::paper) decomposition.ends = eemd::EndRule::mirror;
    const std::vector<double> despiked = despike(valid, found);
    const auto quiet = std::span(despiked).subspan(part.first, part_size);
    const std::vector<double> trend = trend_curve(quiet, decomposition, options.curve);
    const SmoothTrend smoothed = smooth(quiet, options.cutoff_s * series.rate().value());
    std::vector<double> curve = options.trend == TrendMethod::smoother ? smoothed.curve : trend;
    const Interval interval = choose_interval(curve, part.disturbed_first, part.disturbed_last);
    const std::size_t part_begin = run.begin + part.first;
    const std::size_t first = part_begin + interval.first;
    const std::size_t last = part_begin + interval.last;
    const std::size_t length = last - first + 1;
    const auto in_interval = std::span(series.values()).subspan(first, length);
    const auto mean_in_interval = [&](const std::vector<double>& values) {
        return MilliGal(signal::mean_of(std::span(values).subspan(interval.first, length)));
    };

    const auto summarise = [&](const TimeSeries<StandardGravity>& axis,
                               const TimeSeries<StandardGravity>& decimated) {
        return summarise_axis(axis, decimated, kDecimationRatio, first, last);
    };
    const std::vector<std::size_t> present = count_present(record);
    const auto degc = summarise_temperature(temperature, first, last);
    const auto error = block_standard_error(in_interval, samples_in(kBlockSeconds, series.rate()));

    RecordSummary summary;
    summary.series_mean = MilliGal(signal::mean_of(in_interval));
    summary.curve_mean = mean_in_interval(curve);
    summary.eemd_mean = mean_in_interval(trend);
    summary.smoother_mean = mean_in_interval(smoothed.curve);
    summary.smoother_standard_error =
        MilliGal(smoothed.standard_error_of_mean(interval.first, interval.last));
    if (error) summary.standard_error = MilliGal(*error);
    if (degc) summary.temperature_range = degc->range;
    if (degc) summary.temperature_shape = degc->shape;
    summary.counts = count_samples(present, series.size(), reach_of(filter));
    summary.recorded_s = static_cast<double>(series.size()) / series.rate().value();
    summary.x = summarise(record.x, axes.x);
    summary.y = summarise(record.y, axes.y);
    summary.z = summarise(record.z, axes.z);
    summary.rectification =
        signal::rectification_bias(summary.x.rms, summary.y.rms, summary.series_mean);
    return RepresentativeValue{
        summary,
        degc,
        series.time_of(static_cast<double>(first)),
        series.time_of(static_cast<double>(last)),
        flags_of(part, interval, present.back() < record.x.size(), degc.has_value(),
                 options.trend == TrendMethod::eemd || smoothed.converged),
        series,
        {series.time_of(static_cast<double>(part_begin)), series.rate(), std::move(curve)},
        temperature};
}

}  // namespace a351::corrector::reading
