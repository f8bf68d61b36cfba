#pragma once
/// @file
/// A day of set-ups whose readings follow the model exactly, except for noise.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "corrector/whole_day/day_columns.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "protocol/unit/thermal_response.hpp"
#include "tests/support/catch.hpp"

namespace a351::corrector::whole_day {

struct MadeUpDay {
    double level = -15.0, slow = -25.0, fast = 9.0, drift = 0.4, warm_up = 12.0, x = 900.0;
    double fast_lag_s = 55.0, slow_lag_s = 2200.0;
    double constant = 1838.0;
    double placement_mgal = 0.0, white_mgal = 1e-4;
    bool has_two_faces = false;  ///< The faces of the set-ups are + - - +, again and again.
    double scale_share = 0.0;    ///< Share of the thermal effects that acts on the scale.

    [[nodiscard]] double face(std::size_t set_up) const {
        return has_two_faces && (set_up % 4 == 1 || set_up % 4 == 2) ? -1.0 : 1.0;
    }

    static constexpr std::size_t kSetUps = 16;
    static constexpr std::size_t kBins = 14;
    static constexpr std::size_t kSites = 11;

    [[nodiscard]] static UtcTime start() { return *parse_rfc3339("2026-05-01T00:00:00Z"); }

    /// Returns ten hours at 2 s: a daily course and faster waves.
    [[nodiscard]] static TimeSeries<DegC> temperature() {
        std::vector<double> degc(18000);
        for (std::size_t i = 0; i < degc.size(); ++i) {
            const double t_h = static_cast<double>(i) / 1800.0;
            degc[i] = 42.5 + 0.3 * std::sin(0.6 * t_h) + 0.08 * std::sin(5.0 * t_h) +
                      0.01 * std::sin(2.0 * std::numbers::pi * t_h * 4.0);
        }
        return {start(), Hertz(0.5), degc};
    }

    [[nodiscard]] static double gravity_mgal(std::size_t set_up) {
        return 979900.0 + 13.0 * static_cast<double>(set_up % kSites);
    }

    [[nodiscard]] reading::DayRecord record(std::uint64_t seed = 1) const {
        reading::DayRecord day{{temperature(), {}}, {}};
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        for (std::size_t s = 0; s < kSetUps; ++s) {
            const StandardGravity tilt(0.002 * normal(random));
            for (std::size_t b = 0; b < kBins; ++b) {
                reading::DayBin& bin = day.bins.emplace_back();
                bin.set_up = s;
                for (std::size_t i = 0; i < reading::kBinSamples; ++i)
                    bin.times.push_back(
                        start() +
                        from_seconds(3600.0 * (2.0 + 0.5 * static_cast<double>(s)) +
                                     2.0 * static_cast<double>(b * reading::kBinSamples + i)));
                bin.time = bin.times[reading::kBinSamples / 2];
                bin.x = tilt;
                bin.face = face(s);
            }
        }
        const BinMeans means(day.temperature.series, day.bins);
        const auto& degc = day.temperature.series;
        const auto level_degc = means.of(degc.values());
        const auto fast_degc = means.of(unit::lagged(degc, fast_lag_s));
        const auto slow_degc = means.of(unit::lagged(degc, slow_lag_s));
        const UtcTime middle =
            day.bins.front().time + (day.bins.back().time - day.bins.front().time) / 2;
        double placement = 0.0;
        for (std::size_t i = 0; i < day.bins.size(); ++i) {
            reading::DayBin& bin = day.bins[i];
            const auto k = static_cast<Eigen::Index>(i);
            if (i % kBins == 0) placement = placement_mgal * normal(random);
            const double thermal = level * (level_degc(k) - 42.5) +
                                   fast * 3600.0 * (level_degc(k) - fast_degc(k)) / fast_lag_s +
                                   slow * (slow_degc(k) - 42.5);
            const double bias = constant + (1.0 - scale_share) * thermal +
                                drift * seconds_between(middle, bin.time) / 3600.0 +
                                warm_up * std::exp(-seconds_between(start(), bin.time) / 9000.0);
            bin.reading =
                MilliGal(gravity_mgal(bin.set_up) + bin.face * bias + scale_share * thermal +
                         x * bin.x.value() + placement + white_mgal * normal(random));
        }
        return day;
    }

    [[nodiscard]] static std::vector<DayStation> stations() {
        std::vector<DayStation> all;
        for (std::size_t s = 0; s < kSetUps; ++s)
            all.push_back({MilliGal(gravity_mgal(s)), s % kSites});
        return all;
    }
};

/// The day with the usual scatter.
inline const MadeUpDay kScattered{.placement_mgal = 1.2, .white_mgal = 0.2};

/// Adds an error to the readings of a set-up.
inline void add(reading::DayRecord& day, std::size_t set_up, double mgal) {
    for (reading::DayBin& bin : day.bins)
        if (bin.set_up == set_up) bin.reading = bin.reading + MilliGal(mgal);
}

/// Returns the records of a box of sensors: a share of the placement's variance is common.
inline std::vector<reading::DayRecord> box_of(std::size_t sensors, double share,
                                              std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    constexpr double kPlacement_mgal = 1.2;
    std::vector<double> in_common(MadeUpDay::kSetUps);
    for (double& value : in_common) value = kPlacement_mgal * std::sqrt(share) * normal(random);
    std::vector<reading::DayRecord> records;
    for (std::size_t k = 0; k < sensors; ++k) {
        const MadeUpDay day{.placement_mgal = kPlacement_mgal * std::sqrt(1.0 - share),
                            .white_mgal = 0.2};
        records.push_back(day.record(1000 * seed + k));
        for (reading::DayBin& bin : records.back().bins)
            bin.reading = bin.reading + MilliGal(in_common[bin.set_up]);
    }
    return records;
}

inline constexpr std::chrono::hours kOneDay(24);

/// Returns the record later by some time.
inline reading::DayRecord later(reading::DayRecord day, std::chrono::hours by) {
    const auto shifted = [by](const TimeSeries<DegC>& degc) {
        return TimeSeries<DegC>(degc.start() + by, degc.rate(), degc.values());
    };
    day.temperature.series = shifted(day.temperature.series);
    if (day.outer) day.outer = shifted(*day.outer);
    for (reading::DayBin& bin : day.bins) {
        bin.time += by;
        for (UtcTime& time : bin.times) time += by;
    }
    return day;
}

/// Returns the stations of the made-up day without the references of some.
inline std::vector<DayStation> stations_without(const std::vector<std::size_t>& numbers) {
    auto stations = MadeUpDay::stations();
    for (DayStation& station : stations)
        if (std::ranges::find(numbers, station.number) != numbers.end()) station.gravity.reset();
    return stations;
}

/// Returns one survey of an adjustment of several days.
inline DaySurvey survey_of(const reading::DayRecord& record, std::size_t unit,
                           std::vector<DayStation> stations) {
    std::vector<std::size_t> numbers(MadeUpDay::kSites);
    std::iota(numbers.begin(), numbers.end(), 0);
    return {&record, std::move(stations), usual_day_priors(), numbers, unit};
}

/// What an adjustment says of its first survey, and the gravities.
struct FittedDay : DayFit {
    explicit FittedDay(const DayAdjustment& adjustment) : DayFit(adjustment.fit()) {
        for (std::size_t k = 0; k < adjustment.problem().gravity_count(); ++k)
            gravity_mgal.push_back(adjustment.gravity(k));
    }
    std::vector<GravityEstimate> gravity_mgal;
};

/// Returns the fit of a day; std::nullopt if no set-up is held.
/// @param nearby  fit of a similar problem, or null.
inline std::optional<FittedDay> fit_day(const reading::DayRecord& record,
                                        const std::vector<DayStation>& stations,
                                        const DayFit* nearby = nullptr,
                                        const DayPriors& priors = usual_day_priors()) {
    const auto adjusted =
        adjust_day({&record, stations, priors}, nearby == nullptr ? nullptr : &nearby->point);
    if (!adjusted) return std::nullopt;
    return FittedDay(*adjusted);
}

inline const Estimate& coefficient(const DayFit& fit, DayTerm term) {
    return fit.coefficients.at(static_cast<std::size_t>(term));
}

/// Returns a reading without tide, flicker and effects.
inline double corrected_mgal(const DaySetUp& set_up) {
    return (set_up.reading - set_up.tide - set_up.flicker).value() -
           std::accumulate(set_up.effect_mgal.begin(), set_up.effect_mgal.end(), 0.0);
}

/// Returns the day in a box with an outer oven.  Its temperature To has a slow course and a cycle.
/// Its effect on the readings is level To + slow lag(To, 900 s), without a constant.
inline reading::DayRecord with_outer_oven(reading::DayRecord day, double level, double slow) {
    const auto& grid = day.temperature.series;
    std::vector<double> degc(grid.size());
    for (std::size_t i = 0; i < degc.size(); ++i) {
        const double t_h = static_cast<double>(i) / 1800.0;
        degc[i] =
            38.0 + 0.5 * std::sin(1.1 * t_h) + 0.5 * std::sin(2.0 * std::numbers::pi * t_h * 5.0);
    }
    day.outer = TimeSeries<DegC>(grid.start(), grid.rate(), degc);
    const BinMeans means(grid, day.bins);
    const auto prompt = means.of(degc), lagged = means.of(unit::lagged(*day.outer, 900.0));
    for (std::size_t i = 0; i < day.bins.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        MilliGal& reading = day.bins[i].reading;
        reading = reading + MilliGal(level * (prompt(k) - 38.0) + slow * (lagged(k) - 38.0));
    }
    return day;
}

}  // namespace a351::corrector::whole_day
