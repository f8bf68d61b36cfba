#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using text::fixed, text::tr;

// Place of the plot within the picture, from which the place of a label in pixels is computed.
constexpr int kMapWidth_px = 600, kMapHeight_px = 480;
constexpr Frame kFrame{84.0, 106.0, 14.0, 60.0};
constexpr double kPlotWidth_px = kMapWidth_px - kFrame.left - kFrame.right;
constexpr double kPlotHeight_px = kMapHeight_px - kFrame.above - kFrame.below;
constexpr double kLetter_px = 7.0;  // width of the labels' 11 px letters, that of the widest digits
constexpr double kLine_px = 13.0;   // height of a label
constexpr double kKilometresPerDegree = 111.2;  // degree of latitude on a sphere of 6371 km radius

/// A station of the survey on the map.
struct MapStation {
    const text::Site* site = nullptr;
    double gravity_mgal = 0.0;
    std::vector<std::string> visits = {};  ///< Numbers of its stays in the order of the day.
};

/// Longitudes and latitudes over the width and height of the plot.
struct Extent {
    std::array<double, 2> longitude, latitude;

    [[nodiscard]] double width_deg() const { return longitude[1] - longitude[0]; }
    /// Returns the place of a site in px from the lower left corner.
    [[nodiscard]] std::array<double, 2> place_px(const text::Site& site) const {
        return {
            (site.longitude.value() - longitude[0]) / width_deg() * kPlotWidth_px,
            (site.latitude.value() - latitude[0]) / (latitude[1] - latitude[0]) * kPlotHeight_px};
    }
    /// Returns the length of a degree of longitude in degrees of latitude.
    [[nodiscard]] double across() const {
        // The limit keeps the scale finite near a pole, where a map in longitude and latitude is no
        // use.
        const double middle_deg = 0.5 * (latitude[0] + latitude[1]);
        return std::max(0.01, std::cos(middle_deg * kRadPerDeg));
    }
};

Extent extent_of(const std::vector<MapStation>& stations) {
    const auto range = [&](Degrees text::Site::*coordinate) -> std::array<double, 2> {
        const auto [least, greatest] =
            std::ranges::minmax(stations, {}, [coordinate](const MapStation& station) {
                return (station.site->*coordinate).value();
            });
        return {(least.site->*coordinate).value(), (greatest.site->*coordinate).value()};
    };
    Extent extent{range(&text::Site::longitude), range(&text::Site::latitude)};
    constexpr double kShare = 0.75;  // part of the plot for the stations, the rest for labels
    constexpr double kLeastExtent_deg = 1e-3;  // 100 m, for a survey at one place
    const double across = extent.across();
    const double degrees_per_px =
        std::max({extent.width_deg() * across / (kShare * kPlotWidth_px),
                  (extent.latitude[1] - extent.latitude[0]) / (kShare * kPlotHeight_px),
                  kLeastExtent_deg / kPlotWidth_px});
    const auto widen = [](std::array<double, 2>& limits, double half) {
        const double middle = 0.5 * (limits[0] + limits[1]);
        limits = {middle - half, middle + half};
    };
    widen(extent.longitude, 0.5 * kPlotWidth_px * degrees_per_px / across);
    widen(extent.latitude, 0.5 * kPlotHeight_px * degrees_per_px);
    return extent;
}

/// A rectangle in px.
struct Box {
    double left, bottom, right, top;

    [[nodiscard]] bool overlaps(const Box& other) const {
        return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
    }
};

/// Places of a label's near end relative to the point, px, in the order of preference.
constexpr std::array kRight_px{9, -9, 7, 7, -7, -7, 5, -5, 5, -5, 5, 5, -5, -5};
constexpr std::array kUp_px{0, 0, 11, -11, 11, -11, 24, -24, -24, 24, 37, -37, 37, -37};

/// Returns the labels of the stations.  Each is at the first place where it touches no other label
/// and no point; if none is free, at the first place.
std::vector<Text> labels_of(const std::vector<MapStation>& stations, const Extent& extent) {
    constexpr double kPoint_px = 5.0;
    std::vector<Box> taken;
    for (const MapStation& station : stations) {
        const auto [x, y] = extent.place_px(*station.site);
        taken.push_back({x - kPoint_px, y - kPoint_px, x + kPoint_px, y + kPoint_px});
    }
    std::vector<Text> labels;
    for (const MapStation& station : stations) {
        const text::Site& site = *station.site;
        std::string name = short_label(site.name);
        if (!station.visits.empty()) name += fmt::format(" [{}]", text::joined(station.visits));
        const auto [x, y] = extent.place_px(site);
        const double width = kLetter_px * static_cast<double>(name.size());
        const auto box_at = [&](std::size_t place) -> Box {
            const double left = x + kRight_px.at(place) - (kRight_px.at(place) < 0 ? width : 0.0);
            const double middle = y + kUp_px.at(place);
            return {left, middle - kLine_px / 2, left + width, middle + kLine_px / 2};
        };
        std::size_t place = 0;
        for (; place < kUp_px.size(); ++place) {
            const Box box = box_at(place);
            if (box.left > 0 && box.right < kPlotWidth_px && box.bottom > 0 &&
                box.top < kPlotHeight_px &&
                std::ranges::none_of(taken, [&](const Box& b) { return b.overlaps(box); }))
                break;
        }
        if (place == kUp_px.size())
            place = 0;
        else
            taken.push_back(box_at(place));
        labels.push_back(
            {name,
             {(x + kRight_px.at(place)) / kPlotWidth_px, (y + kUp_px.at(place)) / kPlotHeight_px},
             kRight_px.at(place) < 0 ? "right" : "left"});
    }
    return labels;
}

/// Adds a bar of a round length.
void add_scale_bar(Panel& panel, const Extent& extent) {
    const double width_km = extent.width_deg() * extent.across() * kKilometresPerDegree;
    const double length_km = round_step(width_km / 4.0);
    const double share = length_km / width_km;
    const std::string title =
        length_km < 1.0 ? fixed(length_km * 1000.0, 0) + " m" : fixed(length_km, 0) + " km";
    panel.lines.push_back({{0.04, 0.04}, {0.04 + share, 0.04}, true});
    panel.texts.push_back({title, {0.04 + share / 2, 0.065}, "center", Letters::normal});
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
        "6623", {site.longitude.value(), site.latitude.value(), altitude_m, station.gravity_mgal},
        "# " + clean_utf8(site.name) + '\n');
}

}  // namespace

std::optional<Figure> map_figure(const model::SurveyCorrection& result,
                                 const std::vector<text::Site>& sites) {
    std::vector<MapStation> stations;
    std::vector<std::string> absent;
    for (const model::StationValue& station : result.stations) {
        const text::Site* const site = text::find_site(sites, station.site);
        if (site != nullptr && site->is_placed)
            stations.push_back({site, station.gravity.value()});
        else
            absent.push_back(station.site);
    }
    if (stations.empty()) return std::nullopt;
    const Extent extent = extent_of(stations);
    std::string route;
    std::size_t visit = 0;
    for (const std::string& name : visited_sites(result)) {
        ++visit;
        const auto station = std::ranges::find(
            stations, name, [](const MapStation& candidate) { return candidate.site->name; });
        if (station == stations.end()) continue;
        station->visits.push_back(std::to_string(visit));
        route +=
            data_line("66", {station->site->longitude.value(), station->site->latitude.value()},
                      std::to_string(visit) + '\n');
    }
    std::array<std::string, 2> lines;  // with and without a reference
    for (const MapStation& station : stations)
        lines.at(station.site->gravity ? 0 : 1) += station_line(station);

    Figure figure{
        "map",
        tr("Stations with the order of the visits in brackets; colours: gravity in mGal. The scale "
           "is the same in both directions.") +
            (absent.empty()
                 ? ""
                 : tr(" Not shown, because they have no position: {}.", text::joined(absent))),
        kMapWidth_px, kMapHeight_px};
    figure.frame = kFrame;
    const double step_deg = round_step(extent.width_deg() / 3.0);
    const std::string format =
        fmt::format("%.{}f", std::clamp(-std::floor(std::log10(step_deg)), 0.0, 6.0));
    const auto [least, greatest] = std::ranges::minmax(stations, {}, &MapStation::gravity_mgal);
    Panel& panel = figure.panels.emplace_back(Panel{.height_px = kPlotHeight_px});
    panel.x = {tr("Longitude (° east)"), extent.longitude, step_deg, 0.0, format};
    panel.y = {tr("Latitude (° north)"), extent.latitude, step_deg, 0.0, format};
    panel.colours = {.range = {least.gravity_mgal - 0.5, greatest.gravity_mgal + 0.5},
                     .format = "%.0f"};
    panel.key = Key::in_corner;
    panel.texts = labels_of(stations, extent);
    add_scale_bar(panel, extent);
    figure.plot("visits: longitude_deg latitude_deg number", route,
                {Look::line, Colour::route_grey});
    figure.plot("with reference: longitude_deg latitude_deg altitude_m gravity_mgal", lines[0],
                {Look::large_discs, Colour::by_value, tr("known gravity"), {{1}, {2}, {4}}});
    figure.plot("without reference: longitude_deg latitude_deg altitude_m gravity_mgal", lines[1],
                {Look::triangles, Colour::by_value, tr("unknown gravity"), {{1}, {2}, {4}}});
    return figure;
}

}  // namespace a351::corrector::figure
