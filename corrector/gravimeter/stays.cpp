#include "corrector/gravimeter/stays.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "protocol/signal/moments.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// Moves readings of an instrument at an instant that was read before to the refused lines.
void refuse_repeats(std::vector<GravimeterFile>& files) {
    std::set<std::pair<std::string, UtcTime>> seen;
    for (GravimeterFile& file : files) {
        std::vector<Reading> kept;
        for (Reading& reading : file.readings) {
            if (seen.emplace(reading.instrument, reading.time).second)
                kept.push_back(std::move(reading));
            else
                file.refused.push_back(
                    {reading.line, "this instrument has another reading at the same time"});
        }
        file.readings = std::move(kept);
        std::ranges::stable_sort(file.refused, {}, &RefusedLine::line);
    }
}

bool begins_loop(const Reading& last, const Reading& next) {
    return last.dial != next.dial || last.loop != next.loop;
}

bool continues(const Stay& stay, const Reading& next) {
    const Reading& last = *stay.readings.back();
    // An average cannot be of readings with and without the tide.
    return last.site == next.site && !begins_loop(last, next) &&
           last.tide_correction.has_value() == next.tide_correction.has_value() &&
           std::chrono::duration<double>(seconds_between(last.time, next.time)) <= kLongestPause;
}

/// Returns the median; for an even number of values the mean of the two in the middle, because the
/// few readings of a stay have no other without bias.
double centred_median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace

std::vector<Stay> find_stays(std::vector<GravimeterFile>& files) {
    refuse_repeats(files);
    std::map<std::string, std::vector<const Reading*>> by_instrument;
    for (const GravimeterFile& file : files)
        for (const Reading& reading : file.readings)
            by_instrument[reading.instrument].push_back(&reading);
    std::vector<Stay> stays;
    for (auto& [instrument, readings] : by_instrument) {
        std::ranges::stable_sort(readings, {}, &Reading::time);
        int loop = 1;
        const Reading* last = nullptr;
        for (const Reading* const reading : readings) {
            if (last != nullptr && begins_loop(*last, *reading)) ++loop;
            if (last == nullptr || !continues(stays.back(), *reading))
                stays.push_back({instrument, reading->site, 1, loop, {}});
            stays.back().readings.push_back(reading);
            last = reading;
        }
    }
    std::ranges::stable_sort(stays, {},
                             [](const Stay& stay) { return stay.readings.front()->time; });
    std::map<std::string, int> count;
    for (Stay& stay : stays) stay.occupation = ++count[stay.site];
    return stays;
}

StayAverage average_of(const Stay& stay, const AverageOptions& options) {
    StayAverage average;
    average.count =
        options.last == 0 ? stay.readings.size() : std::min(options.last, stay.readings.size());
    const UtcTime first = stay.readings.front()->time;
    std::vector<double> values_mgal, tides_mgal, times_s;
    for (std::size_t i = stay.readings.size() - average.count; i < stay.readings.size(); ++i) {
        const Reading& reading = *stay.readings[i];
        values_mgal.push_back(reading.value.value());
        times_s.push_back(seconds_between(first, reading.time));
        if (reading.tide_correction) tides_mgal.push_back(reading.tide_correction->value());
    }
    average.time = first + from_seconds(signal::mean_of(times_s));
    average.value =
        MilliGal(options.is_mean ? signal::mean_of(values_mgal) : centred_median(values_mgal));
    if (tides_mgal.size() == average.count)
        average.tide_correction = MilliGal(signal::mean_of(tides_mgal));
    if (average.count > 1) average.sd = MilliGal(signal::sample_sd_of(values_mgal));
    return average;
}

}  // namespace a351::corrector::gravimeter
