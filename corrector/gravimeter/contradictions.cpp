#include "corrector/gravimeter/contradictions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "protocol/core/normal_gravity.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

text::Message tide_remark(const GravimeterFile& file, const tide::TideOf& tide_of) {
    std::vector<tide::UsedTide> tides;
    std::vector<std::size_t> line_of;
    for (const Reading& reading : file.readings) {
        if (!reading.tide_correction || !reading.position) continue;
        tides.push_back({reading.time, *reading.position, -reading.tide_correction->value()});
        line_of.push_back(reading.line);
    }
    const auto doubt = tide::find_doubt(tides, tide::kTideOfInstrument, tide_of);
    if (!doubt) return {};
    if (doubt->is_zero)
        return text::message(
            "the tide correction is 0 in all readings, where the tide is up to {:.3f} mGal "
            "(line {}): it is still in them. Use --tide remove, so that the tide is computed "
            "later",
            doubt->size_mgal, line_of[doubt->index]);
    if (doubt->has_other_sign)
        return text::message(
            "the tide in the file has the other sign: it differs from the computed one by up to "
            "{:.3f} mGal (line {}). It is used as it is",
            doubt->size_mgal, line_of[doubt->index]);
    return text::message(
        "the tide in the file is that of another time or place, by up to {:.3f} mGal (line "
        "{}){}: check {}. Times and positions are used as they are",
        doubt->size_mgal, line_of[doubt->index], doubt->remedy,
        file.format == "Scintrex CG-5" ? text::message("GMT DIFF., LONG and LAT")
                                       : text::message("the clock and the position"));
}

/// Two readings that contradict each other.
struct Pair {
    const Reading *first = nullptr, *second = nullptr;
    double size = 0.0;
};

double distance_m(const tide::Station& one, const tide::Station& other) {
    text::Site site;
    site.latitude = one.latitude;
    site.longitude = one.longitude;
    return text::distance(site, other.latitude, other.longitude).value();
}

text::Message position_remark(const GravimeterFile& file) {
    std::map<std::string, const Reading*> first_at;
    std::map<std::string, Pair> far;  // the worst of each station
    for (const Reading& reading : file.readings) {
        if (!reading.position) continue;
        const Reading& first = *first_at.try_emplace(reading.site, &reading).first->second;
        const double size =
            std::max(distance_m(*first.position, *reading.position) / kGreatestDistance_m,
                     std::abs((reading.position->height - first.position->height).value()) /
                         kGreatestHeightDifference_m);
        Pair& pair = far[reading.site];
        if (size > std::max(1.0, pair.size)) pair = {&first, &reading, size};
    }
    Pair worst;
    std::size_t count = 0;
    for (const auto& [site, pair] : far) {
        if (pair.size > 0.0) ++count;
        if (pair.size > worst.size) worst = pair;
    }
    if (count == 0) return {};
    const tide::Station &one = *worst.first->position, &other = *worst.second->position;
    return text::message(
        "positions of one station differ (stations: {}), the most at {}: {:.0f} m, and {:+.0f} "
        "m of height (lines {} and {}), {:+.2f} mGal of normal gravity. The first position of a "
        "station is used",
        count, worst.first->site, distance_m(one, other), (other.height - one.height).value(),
        worst.first->line, worst.second->line,
        (normal_gravity(other.latitude, other.height) - normal_gravity(one.latitude, one.height))
            .value());
}

text::Message receiver_remark(const GravimeterFile& file) {
    const Reading* worst = nullptr;
    double largest = kGreatestDistance_m;
    for (const Reading& reading : file.readings) {
        if (!reading.position || !reading.receiver) continue;
        const double size = distance_m(*reading.position, *reading.receiver);
        if (size > largest) {
            largest = size;
            worst = &reading;
        }
    }
    if (worst == nullptr) return {};
    return text::message(
        "the receiver is up to {:.0f} m from the position that was entered, at {} (line {}), "
        "{:+.2f} mGal of normal gravity. The position that was entered is used",
        largest, worst->site, worst->line,
        (normal_gravity(worst->receiver->latitude) - normal_gravity(worst->position->latitude))
            .value());
}

text::Message stay_number_remark(const GravimeterFile& file) {
    const auto number_of = [](const Reading& reading) -> std::string_view {
        for (const auto& [name, text] : reading.kept)
            if (name == "stay_number") return text;
        return {};
    };
    std::map<std::pair<std::string, std::string_view>, const Reading*> last_of;
    const Reading* last = nullptr;
    Pair longest;
    std::size_t count = 0;
    for (const Reading& reading : file.readings) {
        const auto number = number_of(reading);
        const Reading*& before = last_of[{reading.site, number}];
        if (!number.empty() && before != nullptr && last->site != reading.site) {
            ++count;
            const double size = std::abs(seconds_between(before->time, reading.time));
            if (size >= longest.size) longest = {before, &reading, size};
        }
        last = before = &reading;
    }
    if (count == 0) return {};
    return text::message(
        "stay numbers come back after other stations ({}); the longest pause is {:.1f} h, at {} "
        "with number {} (lines {} and {}), where the reading changes by {:+.3f} mGal. A new "
        "stay begins each time",
        count, longest.size / kSecondsPerHour, longest.first->site, number_of(*longest.first),
        longest.first->line, longest.second->line,
        (longest.second->value - longest.first->value).value());
}

text::Message tide_switch_remark(const GravimeterFile& file, const tide::TideOf& tide_of) {
    const Reading* first = nullptr;
    std::size_t count = 0;
    double largest = 0.0;
    for (const Reading& reading : file.readings) {
        if (reading.tide_correction) continue;
        if (++count == 1) first = &reading;
        if (reading.position)
            largest = std::max(largest, std::abs(tide_of(reading.time, *reading.position).value()));
    }
    if (count == 0 || count == file.readings.size()) return {};
    return text::message(
        "the tide correction is off in {} of {} readings, the first at line {}, where the tide "
        "is up to {:.3f} mGal. Each reading is used as its header or flag says",
        count, file.readings.size(), first->line, largest);
}

}  // namespace

std::vector<text::Message> contradictions(const GravimeterFile& file, const tide::TideOf& tide_of) {
    std::vector<text::Message> remarks;
    for (text::Message remark :
         {tide_remark(file, tide_of), position_remark(file), receiver_remark(file),
          stay_number_remark(file), tide_switch_remark(file, tide_of)})
        if (!remark.empty()) remarks.push_back(std::move(remark));
    return remarks;
}

}  // namespace a351::corrector::gravimeter
