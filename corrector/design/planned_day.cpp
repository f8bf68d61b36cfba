#include "corrector/design/planned_day.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::design {
namespace {

// Cycle of the publication's oven: 10 to 15 min, about 0.02 degC peak to peak.
constexpr double kCycle_s = 900.0, kCycle_degc = 0.01;
constexpr double kTemperatureRate_hz = 0.5;  // that of the day's smoothed temperature at 50 Hz
constexpr double kSample_s = 2.0;            // that of the decimated axes at 50 Hz
constexpr double kHandling_s = 25.0;
constexpr std::size_t kFewestSamples = 8;  // of a bin, as bin_set_up()

// Periods of the waves that make the walk, h: from a visit to some days.
constexpr std::array<double, 7> kWaves_h{1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};
// Their square roots are independent over the rational numbers.
constexpr std::array<double, kWaves_h.size() + 2> kPrimes{2.0,  3.0,  5.0,  7.0, 11.0,
                                                          13.0, 17.0, 19.0, 23.0};

/// Returns a phase of one of the waves in a course.
double phase(std::size_t course, std::size_t wave) {
    const double turns = (static_cast<double>(course) + 0.5) * std::sqrt(kPrimes.at(wave));
    return 2.0 * std::numbers::pi * (turns - std::floor(turns));
}

/// Returns the bins of a set-up, without readings.
std::vector<reading::DayBin> planned_bins(std::size_t set_up, UtcTime start, double minutes) {
    std::vector<reading::DayBin> bins;
    const auto samples = static_cast<std::size_t>((60.0 * minutes - 2.0 * kHandling_s) / kSample_s);
    for (std::size_t first = 0; first + kFewestSamples <= samples; first += reading::kBinSamples) {
        reading::DayBin bin;
        bin.set_up = set_up;
        const std::size_t last = std::min(first + reading::kBinSamples, samples) - 1;
        const auto time_of = [&](double sample) {
            return start + from_seconds(kHandling_s + kSample_s * (sample + 0.5));
        };
        for (std::size_t i = first; i <= last; ++i)
            bin.times.push_back(time_of(static_cast<double>(i)));
        bin.time = time_of(0.5 * static_cast<double>(first + last));
        bins.push_back(std::move(bin));
    }
    return bins;
}

}  // namespace

TimeSeries<DegC> planned_temperature(UtcTime start, UtcTime end, double walk_degc_per_sqrt_h,
                                     std::size_t course) {
    // Waves of amplitude a P^0.5, one per octave, have the structure function of a random walk,
    // (a pi)^2 / ln 2 x time.
    const double amplitude = walk_degc_per_sqrt_h * std::sqrt(std::numbers::ln2) / std::numbers::pi;
    std::vector<double> degc(
        static_cast<std::size_t>(seconds_between(start, end) * kTemperatureRate_hz) + 1);
    const auto add = [&](double degc_peak, double period_s, double phase_rad) {
        const double step = 2.0 * std::numbers::pi / (period_s * kTemperatureRate_hz);
        for (std::size_t i = 0; i < degc.size(); ++i)
            degc[i] += degc_peak * std::cos(step * static_cast<double>(i) + phase_rad);
    };
    std::ranges::fill(degc, unit::kTypicalUnit.set_point_degc);
    for (std::size_t wave = 0; wave < kWaves_h.size(); ++wave)
        add(amplitude * std::sqrt(kWaves_h.at(wave)), kSecondsPerHour * kWaves_h.at(wave),
            phase(course, wave));
    add(kCycle_degc, kCycle_s, phase(course, kWaves_h.size()));
    return {start, Hertz(kTemperatureRate_hz), std::move(degc)};
}

PlannedDay planned_day(const Plan& plan, const std::vector<text::Site>& sites,
                       const PlannedUnit& unit, std::size_t course) {
    const UtcTime start = plan.front().start - from_seconds(kLead_h * kSecondsPerHour);
    const UtcTime end = plan.back().end() + from_seconds(kSecondsPerMinute);
    PlannedDay day{
        {{planned_temperature(start, end, unit.walk_degc_per_sqrt_h, course), {}}, {}}, {}, {}};
    for (const Visit& visit : plan) {
        const text::Site& site = *text::find_site(sites, visit.site);
        const auto found = std::ranges::find(day.sites, site.name);
        const auto number = static_cast<std::size_t>(found - day.sites.begin());
        if (found == day.sites.end()) day.sites.push_back(site.name);
        for (int part = 0; part < visit.set_ups; ++part) {
            const std::size_t set_up = day.stations.size();
            const double turns = static_cast<double>((course + 1) * set_up) / std::numbers::phi;
            const double direction = phase(course, kWaves_h.size() + 1) +
                                     2.0 * std::numbers::pi * (turns - std::floor(turns));
            const double tilt = std::numbers::sqrt2 * unit.tilt_g;
            for (reading::DayBin& bin :
                 planned_bins(set_up, visit.start + from_seconds(60.0 * part * visit.minutes_each),
                              visit.minutes_each)) {
                bin.face = visit.face(part);
                bin.x = StandardGravity(tilt * std::cos(direction));
                bin.y = StandardGravity(tilt * std::sin(direction));
                day.record.bins.push_back(std::move(bin));
            }
            day.stations.push_back({site.gravity, number, site.u_gravity.value_or(MilliGal(0.0))});
        }
    }
    return day;
}

}  // namespace a351::corrector::design
