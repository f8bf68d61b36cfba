#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/layout.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using text::fixed, text::tr;

constexpr double kLabel_mm = 3.0;               // height of a label
constexpr double kNear_mm = 1.8;                // from a point to a label beside it
constexpr double kKilometresPerDegree = 111.2;  // degree of latitude on a sphere of 6371 km radius

/// A station of the survey on the map.
struct MapStation {
    const text::Site* site = nullptr;
    double gravity_mgal = 0.0;
    double longitude_deg = 0.0;  ///< Within 180 degrees of that of the first station.
    double latitude_deg = 0.0;
    std::vector<std::string> visits = {};  ///< Numbers of its stays in the order of the day.
};

/// Longitudes and latitudes over the width and height of the plot.
struct Extent {
    double width_mm, height_mm;
    std::array<double, 2> longitude = {}, latitude = {};

    [[nodiscard]] double width_deg() const { return longitude[1] - longitude[0]; }
    /// Returns the place of a station in mm from the lower left corner.
    [[nodiscard]] std::array<double, 2> place_mm(const MapStation& station) const {
        return {(station.longitude_deg - longitude[0]) / width_deg() * width_mm,
                (station.latitude_deg - latitude[0]) / (latitude[1] - latitude[0]) * height_mm};
    }
    /// Returns the length of a degree of longitude in degrees of latitude.
    [[nodiscard]] double across() const {
        // The limit keeps the scale finite near a pole, where a map in longitude and latitude is no
        // use.
        const double middle_deg = 0.5 * (latitude[0] + latitude[1]);
        return std::max(0.01, std::cos(middle_deg * kRadPerDeg));
    }
};

Extent extent_of(const std::vector<MapStation>& stations, double width_mm, double height_mm) {
    const auto range = [&](double MapStation::*coordinate) -> std::array<double, 2> {
        const auto [least, greatest] = std::ranges::minmax(stations, {}, coordinate);
        return {least.*coordinate, greatest.*coordinate};
    };
    Extent extent{width_mm, height_mm, range(&MapStation::longitude_deg),
                  range(&MapStation::latitude_deg)};
    constexpr double kShare = 0.75;  // part of the plot for the stations, the rest for labels
    constexpr double kLeastExtent_deg = 1e-3;  // 100 m, for a survey at one place
    const double across = extent.across();
    const double degrees_per_mm =
        std::max({extent.width_deg() * across / (kShare * width_mm),
                  (extent.latitude[1] - extent.latitude[0]) / (kShare * height_mm),
                  kLeastExtent_deg / width_mm});
    const auto widen = [](std::array<double, 2>& limits, double half) {
        const double middle = 0.5 * (limits[0] + limits[1]);
        limits = {middle - half, middle + half};
    };
    widen(extent.longitude, 0.5 * width_mm * degrees_per_mm / across);
    widen(extent.latitude, 0.5 * height_mm * degrees_per_mm);
    return extent;
}

/// A rectangle in mm.
struct Box {
    double left, bottom, right, top;

    [[nodiscard]] bool overlaps(const Box& other) const {
        return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
    }

    /// Returns true if the way from one point to the other passes through the rectangle.
    [[nodiscard]] bool is_crossed(const std::array<double, 2>& from,
                                  const std::array<double, 2>& to) const {
        double first = 0.0, last = 1.0;  // part of the way that is within
        const std::array<double, 2> low{left, bottom}, high{right, top};
        for (std::size_t k = 0; k < 2; ++k) {
            const double step = to.at(k) - from.at(k);
            const double enter = (low.at(k) - from.at(k)) / step,
                         leave = (high.at(k) - from.at(k)) / step;
            if (step == 0.0) {
                if (from.at(k) < low.at(k) || from.at(k) > high.at(k)) return false;
                continue;
            }
            first = std::max(first, std::min(enter, leave));
            last = std::min(last, std::max(enter, leave));
        }
        return first < last;
    }
};

/// Places of a label's near end relative to the point, mm, in the order of preference.
std::vector<std::array<double, 2>> label_places() {
    std::vector<std::array<double, 2>> places{{kNear_mm, 0.0}, {-kNear_mm, 0.0}};
    for (int line = 1; line <= 6; ++line)
        for (const double right : {kNear_mm, -kNear_mm})
            for (const double up : {0.9 * kLabel_mm, -0.9 * kLabel_mm})
                places.push_back({right * (line > 1 ? 2.0 : 1.0), up * line});
    // Farther to the side; a pointer leads there.
    for (const double across_mm : {8.0, 14.0, 20.0})
        for (int line = 0; line <= 8; ++line)
            for (const double side : {1.0, -1.0})
                for (const double up : {0.9 * kLabel_mm, -0.9 * kLabel_mm})
                    places.push_back({side * across_mm, up * line});
    return places;
}

/// Adds the labels of the stations.  Each is at the first place where it touches no other label,
/// no point and no way; if none is free, at the first where it crosses ways only, and if there is
/// none either, it is left out.  A pointer, which crosses no label, leads to a label that is not beside
/// its point.
/// @param ways  points in the order of the visits, mm.
/// @return the labels that are left out.
std::vector<std::string> add_labels(Panel& panel, const std::vector<MapStation>& stations,
                                    const Extent& extent,
                                    const std::vector<std::array<double, 2>>& ways) {
    constexpr double kPoint_mm = 1.3;
    std::vector<std::string> left_out;
    std::vector<Box> taken;
    std::vector<std::array<std::array<double, 2>, 2>> pointers;
    for (const MapStation& station : stations) {
        const auto [x, y] = extent.place_mm(station);
        taken.push_back({x - kPoint_mm, y - kPoint_mm, x + kPoint_mm, y + kPoint_mm});
    }
    const auto places = label_places();
    for (const MapStation& station : stations) {
        std::string name = short_label(station.site->name);
        if (!station.visits.empty()) name += fmt::format(" [{}]", text::joined(station.visits));
        const auto point = extent.place_mm(station);
        const double width = text_width_mm(name, kSmallLetters_pt);
        const auto is_far = [](const std::array<double, 2>& place) {
            return std::abs(place[1]) > kLabel_mm || std::abs(place[0]) > 2.0 * kNear_mm;
        };
        const auto is_free = [&](const std::array<double, 2>& place, bool may_cross) {
            const double left = point[0] + place[0] - (place[0] < 0 ? width : 0.0);
            const double middle = point[1] + place[1];
            const Box box{left, middle - kLabel_mm / 2, left + width, middle + kLabel_mm / 2};
            if (box.left < 0 || box.right > extent.width_mm || box.bottom < 0 ||
                box.top > extent.height_mm ||
                std::ranges::any_of(taken, [&](const Box& other) { return other.overlaps(box); }))
                return false;
            for (std::size_t k = 1; !may_cross && k < ways.size(); ++k)
                if (box.is_crossed(ways[k - 1], ways[k])) return false;
            for (const auto& [from, to] : pointers)
                if (box.is_crossed(from, to)) return false;
            if (is_far(place)) {
                const std::array<double, 2> end{point[0] + place[0], middle};
                for (std::size_t k = stations.size(); k < taken.size(); ++k)
                    if (taken[k].is_crossed(point, end)) return false;
                pointers.push_back({point, end});
            }
            taken.push_back(box);
            return true;
        };
        auto place = places.end();
        for (const bool may_cross : {false, true})
            if (place == places.end())
                place = std::ranges::find_if(
                    places, [&](const auto& candidate) { return is_free(candidate, may_cross); });
        if (place == places.end()) {
            left_out.push_back(station.site->name);
            continue;
        }
        const auto at = [&](double x, double y) -> Place {
            return {x / extent.width_mm, y / extent.height_mm};
        };
        const Place end = at(point[0] + (*place)[0], point[1] + (*place)[1]);
        if (is_far(*place)) panel.lines.push_back({at(point[0], point[1]), end, Stroke::pointer});
        panel.texts.push_back({name, end, (*place)[0] < 0 ? "right" : "left"});
    }
    return left_out;
}

/// Adds a bar of a round length.
void add_scale_bar(Panel& panel, const Extent& extent) {
    const double width_km = extent.width_deg() * extent.across() * kKilometresPerDegree;
    const double length_km = round_step(width_km / 4.0);
    const double share = length_km / width_km;
    const std::string title =
        length_km < 1.0 ? fixed(length_km * 1000.0, 0) + " m" : fixed(length_km, 0) + " km";
    panel.lines.push_back({{0.04, 0.04}, {0.04 + share, 0.04}, Stroke::scale_bar});
    panel.texts.push_back({title, {0.04 + share / 2, 0.07}, "center"});
}

/// Returns the site of each stay in the order of time, stays without a value too.
std::vector<std::string> visited_sites(const model::SurveyCorrection& result) {
    std::map<UtcTime, std::pair<std::string, int>> stays;
    for (const model::CorrectedRow& row : result.rows)
        stays[row.row.time] = {row.row.site, row.row.occupation};
    for (const reading::LeftOut& stay : result.left_out)
        stays[stay.start] = {stay.site, stay.occupation};
    std::vector<std::string> sites;
    const std::pair<std::string, int>* before = nullptr;
    for (const auto& [time, stay] : stays) {
        if (before == nullptr || *before != stay) sites.push_back(stay.first);
        before = &stay;
    }
    return sites;
}

std::string station_line(const MapStation& station) {
    const text::Site& site = *station.site;
    const double altitude_m = site.has_altitude ? site.altitude.value() : std::nan("");
    return data_line(
        "6623", {station.longitude_deg, station.latitude_deg, altitude_m, station.gravity_mgal},
        "# " + clean_utf8(site.name) + '\n');
}

}  // namespace

std::optional<Figure> map_figure(const model::SurveyCorrection& result,
                                 const std::vector<text::Site>& sites, const Print& print) {
    std::vector<MapStation> stations;
    std::vector<std::string> absent;
    // A survey across the 180th meridian is drawn in one piece.
    const auto near_first = [&stations](const text::Site& site) {
        const double longitude_deg = site.longitude.value();
        if (stations.empty()) return longitude_deg;
        const double first_deg = stations.front().longitude_deg;
        return std::abs(longitude_deg - first_deg) <= 180.0
                   ? longitude_deg
                   : first_deg + std::remainder(longitude_deg - first_deg, 360.0);
    };
    for (const model::StationValue& station : result.stations) {
        const text::Site* const site = text::find_site(sites, station.site);
        if (site != nullptr && site->is_placed)
            stations.push_back(
                {site, station.gravity.value(), near_first(*site), site->latitude.value()});
        else
            absent.push_back(station.site);
    }
    if (stations.empty()) return std::nullopt;
    Panel panel;
    panel.colours.label = tr("Gravity (mGal)");
    const double width_mm = print.small_mm();
    panel.height_mm = width_mm <= kColumn_mm ? 70.0 : 100.0;
    const Extent extent = extent_of(stations, panel_width_mm(width_mm, panel), panel.height_mm);
    std::vector<std::array<double, 2>> ways;
    std::string route;
    std::size_t visit = 0;
    for (const std::string& name : visited_sites(result)) {
        ++visit;
        const auto station = std::ranges::find(
            stations, name, [](const MapStation& candidate) { return candidate.site->name; });
        if (station == stations.end()) continue;
        station->visits.push_back(std::to_string(visit));
        ways.push_back(extent.place_mm(*station));
        route += data_line("66", {station->longitude_deg, station->latitude_deg},
                           std::to_string(visit) + '\n');
    }
    std::array<std::string, 2> lines;  // with and without a reference
    for (const MapStation& station : stations)
        lines.at(station.site->gravity ? 0 : 1) += station_line(station);

    Figure figure{
        "map",
        tr("Stations with the order of the visits in brackets; colours: gravity in mGal. The scale "
           "is the same in both directions.") +
            as_published("8") +
            (absent.empty()
                 ? ""
                 : tr(" Not shown, because they have no position: {}.", text::joined(absent))),
        width_mm};
    const double step_deg = round_step(extent.width_deg() / 3.0);
    const std::string format =
        fmt::format("%.{}f", std::clamp(-std::floor(std::log10(step_deg)), 0.0, 6.0));
    const auto [least, greatest] = std::ranges::minmax(stations, {}, &MapStation::gravity_mgal);
    panel.x = {tr("Longitude (° east)"), extent.longitude, step_deg, format};
    panel.y = {tr("Latitude (° north)"), extent.latitude, step_deg, format};
    panel.colours.range = {least.gravity_mgal - 0.5, greatest.gravity_mgal + 0.5};
    panel.colours.format = "%.0f";
    figure.caption += without_room(add_labels(panel, stations, extent, ways));
    add_scale_bar(panel, extent);
    figure.panels = {panel};
    figure.plot("visits: longitude_deg latitude_deg number", route,
                {Look::line, Colour::route_grey});
    figure.plot("with reference: longitude_deg latitude_deg altitude_m gravity_mgal", lines[0],
                {Look::large_discs, Colour::by_value, tr("known gravity"), {1, 2, 4}});
    figure.plot("without reference: longitude_deg latitude_deg altitude_m gravity_mgal", lines[1],
                {Look::triangles, Colour::by_value, tr("unknown gravity"), {1, 2, 4}});
    return figure;
}

}  // namespace a351::corrector::figure
