#include "corrector/reading/day_record.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "corrector/reading/disturbance.hpp"
#include "corrector/reading/smoother.hpp"

namespace a351::corrector::reading {
namespace {

/// Reach of both decimation filters in samples of 2 s: 41 + 10 x 41 samples of 0.02 s, rounded up.
constexpr std::size_t kReach = 5;
constexpr std::size_t kFewestOfBin = 8;
constexpr double kCutoff_s = 120.0;
constexpr double kShortestTemperature_s = 600.0;

/// Returns true for each sample that is valid and far from any disturbance.
std::vector<bool> quiet_samples(const std::vector<double>& series, double threshold) {
    std::vector<double> valid;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < series.size(); ++i) {
        if (std::isnan(series[i])) continue;
        valid.push_back(series[i]);
        places.push_back(i);
    }
    std::vector<bool> is_quiet(series.size(), false);
    if (valid.empty()) return is_quiet;
    const Disturbances found = find_disturbances(valid, threshold);
    for (const std::size_t place : places) is_quiet[place] = true;
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (!found.disturbed[k]) continue;
        const std::size_t first = places[k] - std::min(places[k], kReach);
        const std::size_t end = std::min(series.size(), places[k] + kReach + 1);
        for (std::size_t i = first; i < end; ++i) is_quiet[i] = false;
    }
    return is_quiet;
}

struct Stretch {
    std::size_t first, end;
};

/// Returns the parts of the series between gaps longer than `most` samples.  Each part begins and
/// ends with a value.
std::vector<Stretch> runs_between_gaps(std::span<const double> values, std::size_t most) {
    std::vector<Stretch> runs;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) continue;
        if (runs.empty() || i - runs.back().end > most) runs.push_back({i, i});
        runs.back().end = i + 1;
    }
    return runs;
}

/// Fills the values between two samples with a straight line.
void bridge(std::vector<double>& values, std::size_t before, std::size_t after) {
    const double rise = (values[after] - values[before]) / static_cast<double>(after - before);
    for (std::size_t i = before + 1; i < after; ++i)
        values[i] = values[before] + rise * static_cast<double>(i - before);
}

}  // namespace

std::vector<DayBin> bin_set_up(std::size_t set_up, const DecimatedAxes& axes, double threshold) {
    const TimeSeries<StandardGravity> size = signal::norm(axes.x, axes.y, axes.z);
    const std::vector<bool> is_quiet = quiet_samples(size.values(), threshold);

    std::vector<DayBin> bins;
    for (std::size_t first = 0; first < size.size(); first += kBinSamples) {
        DayBin bin;
        bin.set_up = set_up;
        // 1 g is subtracted before summing, to keep the last digits.
        double reading_g = 0.0, x_g = 0.0, y_g = 0.0, after_s = 0.0;
        const std::size_t end = std::min(size.size(), first + kBinSamples);
        for (std::size_t i = first; i < end; ++i) {
            if (!is_quiet[i]) continue;
            bin.times.push_back(size.time_of(static_cast<double>(i)));
            after_s += seconds_between(size.start(), bin.times.back());
            reading_g += size.values()[i] - 1.0;
            x_g += axes.x.values()[i];
            y_g += axes.y.values()[i];
        }
        if (bin.times.size() < kFewestOfBin) continue;
        const auto n = static_cast<double>(bin.times.size());
        bin.time = size.start() + from_seconds(after_s / n);
        bin.reading = MilliGal((1.0 + reading_g / n) * kMilliGalPerStandardGravity);
        bin.x = StandardGravity(x_g / n);
        bin.y = StandardGravity(y_g / n);
        bins.push_back(std::move(bin));
    }
    return bins;
}

std::vector<double> faces_of(const std::vector<DayBin>& bins, std::size_t set_ups) {
    std::vector<double> faces(set_ups, 1.0);
    for (const DayBin& bin : bins) faces[bin.set_up] = bin.face;
    return faces;
}

bool has_two_faces(const std::vector<DayBin>& bins) {
    return std::ranges::any_of(
        bins, [&bins](const DayBin& bin) { return bin.face != bins.front().face; });
}

std::optional<DayTemperature> day_temperature(const TimeSeries<DegC>& decimated) {
    const double cutoff = kCutoff_s * decimated.rate().value();
    std::vector<double> values = decimated.values();
    const std::vector<Stretch> runs =
        runs_between_gaps(values, static_cast<std::size_t>(cutoff) / 2);
    std::size_t valid = 0;
    for (const Stretch& run : runs) {
        valid += run.end - run.first;
        if (run.end - run.first < static_cast<std::size_t>(cutoff)) continue;
        const auto part = std::span(values).subspan(run.first, run.end - run.first);
        const SmoothTrend smooth_part = smooth(part, cutoff);
        std::copy(smooth_part.curve.begin(), smooth_part.curve.end(), part.begin());
    }
    if (static_cast<double>(valid) < kShortestTemperature_s * decimated.rate().value())
        return std::nullopt;
    std::optional<std::size_t> last;
    for (std::size_t i = runs.front().first; i < runs.back().end; ++i) {
        if (std::isnan(values[i])) continue;
        if (last && i - *last > 1) bridge(values, *last, i);
        last = i;
    }
    std::vector<TemperatureGap> gaps;
    const std::size_t first = runs.front().first;
    for (std::size_t k = 1; k < runs.size(); ++k)
        gaps.push_back({runs[k - 1].end - 1 - first, runs[k].first - first});
    const auto begin = values.begin();
    std::vector<double> kept(begin + static_cast<std::ptrdiff_t>(first),
                             begin + static_cast<std::ptrdiff_t>(runs.back().end));
    return DayTemperature{
        {decimated.time_of(static_cast<double>(first)), decimated.rate(), std::move(kept)},
        std::move(gaps)};
}

bool DayTemperature::is_bridged(UtcTime time) const {
    return std::ranges::any_of(gaps, [&](const TemperatureGap& gap) {
        return series.time_of(static_cast<double>(gap.before)) < time &&
               time < series.time_of(static_cast<double>(gap.after));
    });
}

double DayTemperature::longest_gap_s() const {
    std::size_t longest = 0;
    for (const TemperatureGap& gap : gaps) longest = std::max(longest, gap.after - gap.before - 1);
    return static_cast<double>(longest) / series.rate().value();
}

}  // namespace a351::corrector::reading
