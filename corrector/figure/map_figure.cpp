#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

// Position of the plot within the SVG, from which the position of a label in pixels is computed.
constexpr int kMapWidth_px = 820, kMapHeight_px = 600;
constexpr double kLeft = 0.12, kRight = 0.84, kBottom = 0.10, kTop = 0.97;
constexpr double kPlotWidth_px = (kRight - kLeft) * kMapWidth_px;
constexpr double kPlotHeight_px = (kTop - kBottom) * kMapHeight_px;
constexpr double kLetter_px = 7.0;  // width of the labels' 11 px letters, that of the widest digits
constexpr double kLine_px = 15.0, kLabel_px = 2.0 * kLine_px;
constexpr double kKilometresPerDegree = 111.2;  // degree of latitude on a sphere of 6371 km radius

struct Range {
    double least = 0.0, greatest = 0.0;

    [[nodiscard]] double middle() const { return 0.5 * (least + greatest); }
    [[nodiscard]] double length() const { return greatest - least; }
};

/// Longitudes and latitudes over the width and height of the plot.
struct Frame {
    Range longitude, latitude;

    [[nodiscard]] double x_px(double longitude_deg) const {
        return (longitude_deg - longitude.least) / longitude.length() * kPlotWidth_px;
    }
    [[nodiscard]] double y_px(double latitude_deg) const {
        return (latitude_deg - latitude.least) / latitude.length() * kPlotHeight_px;
    }
};

struct Box {
    double left, bottom, right, top;

    [[nodiscard]] bool overlaps(const Box& other) const {
        return left < other.right && other.left < right && bottom < other.top && other.bottom < top;
    }
};

Range range_of(const std::vector<const text::Site*>& sites, Degrees text::Site::*coordinate) {
    Range range{(sites.front()->*coordinate).value(), (sites.front()->*coordinate).value()};
    for (const text::Site* site : sites) {
        range.least = std::min(range.least, (site->*coordinate).value());
        range.greatest = std::max(range.greatest, (site->*coordinate).value());
    }
    return range;
}

double cosine(double latitude_deg) {
    // The limit keeps the scale finite near a pole, where a map in longitude and latitude is no
    // use.
    return std::max(0.01, std::cos(latitude_deg * kRadPerDeg));
}

Frame frame_around(const std::vector<const text::Site*>& sites) {
    const Range longitude = range_of(sites, &text::Site::longitude);
    const Range latitude = range_of(sites, &text::Site::latitude);
    constexpr double kShare = 0.75;  // part of the plot for the stations, the rest for labels
    constexpr double kLeastExtent_deg = 1e-3;  // 100 m, for a survey at one place
    const double across = cosine(latitude.middle());
    const double degrees_per_px =
        std::max({longitude.length() * across / (kShare * kPlotWidth_px),
                  latitude.length() / (kShare * kPlotHeight_px), kLeastExtent_deg / kPlotWidth_px});
    const double half_width = 0.5 * kPlotWidth_px * degrees_per_px / across;
    const double half_height = 0.5 * kPlotHeight_px * degrees_per_px;
    return {{longitude.middle() - half_width, longitude.middle() + half_width},
            {latitude.middle() - half_height, latitude.middle() + half_height}};
}

struct LabelPlace {
    double x_px, y_px;  ///< Position of the label's near end relative to the point.
    bool is_left;       ///< The label is left of its near end.
};
constexpr std::array<LabelPlace, 14> kPlaces{{{9, 0, false},
                                              {-9, 0, true},
                                              {7, 22, false},
                                              {7, -22, false},
                                              {-7, 22, true},
                                              {-7, -22, true},
                                              {5, 46, false},
                                              {-5, -46, true},
                                              {5, -46, false},
                                              {-5, 46, true},
                                              {5, 70, false},
                                              {5, -70, false},
                                              {-5, 70, true},
                                              {-5, -70, true}}};

/// Finds for each label the first place where it touches no other label and no point.  If none is
/// free, it takes the first place.
class LabelPlacer {
public:
    LabelPlacer(const Frame& frame, const std::vector<const text::Site*>& sites) : frame_(frame) {
        constexpr double kPoint_px = 5.0;
        for (const text::Site* site : sites) {
            const double x = frame.x_px(site->longitude.value());
            const double y = frame.y_px(site->latitude.value());
            taken_.push_back({x - kPoint_px, y - kPoint_px, x + kPoint_px, y + kPoint_px});
        }
    }

    LabelPlace place(const text::Site& site, std::size_t letter_count) {
        for (const LabelPlace& candidate : kPlaces) {
            const Box box = box_of(site, candidate, letter_count);
            const bool is_inside = box.left > 0 && box.right < kPlotWidth_px && box.bottom > 0 &&
                                   box.top < kPlotHeight_px;
            const bool is_free =
                std::ranges::none_of(taken_, [&box](const Box& b) { return b.overlaps(box); });
            if (!is_inside || !is_free) continue;
            taken_.push_back(box);
            return candidate;
        }
        return kPlaces.front();
    }

private:
    [[nodiscard]] Box box_of(const text::Site& site, const LabelPlace& place,
                             std::size_t letter_count) const {
        const double x = frame_.x_px(site.longitude.value()) + place.x_px;
        const double y = frame_.y_px(site.latitude.value()) + place.y_px;
        const double width = kLetter_px * static_cast<double>(letter_count);
        return {place.is_left ? x - width : x, y - kLabel_px / 2, place.is_left ? x : x + width,
                y + kLabel_px / 2};
    }

    Frame frame_;
    std::vector<Box> taken_;
};

std::string bar(const Frame& frame) {
    const double across = cosine(frame.latitude.middle());
    const double width_km = frame.longitude.length() * across * kKilometresPerDegree;
    const double length_km = round_step(width_km / 4.0);
    const double share = length_km / width_km;
    const std::string title = length_km < 1.0 ? text::fixed(length_km * 1000.0, 0) + " m"
                                              : text::fixed(length_km, 0) + " km";
    return fmt::format(
        "set arrow from graph 0.04,0.04 to graph {},0.04 heads size graph 0.008,90 lw 1.5 front\n"
        "set label '{}' at graph {},0.065 center front\n",
        text::fixed(0.04 + share, 5), title, text::fixed(0.04 + share / 2, 5));
}

/// A station of the survey on the map.
struct MapStation {
    const text::Site* site = nullptr;
    double gravity_mgal = 0.0;
    std::vector<std::string> visits;  ///< Numbers of its stays in the order of the day.
};

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

/// Returns the data of the stations with a reference, or of those without.
std::string station_lines(const std::vector<MapStation>& stations, bool is_known) {
    std::string lines;
    for (const MapStation& station : stations) {
        const text::Site& site = *station.site;
        if (site.gravity.has_value() != is_known) continue;
        const double altitude_m =
            site.has_altitude ? site.altitude.value() : std::numeric_limits<double>::quiet_NaN();
        lines += fmt::format("{}{}{}{}# {}\n", datum(site.longitude.value(), 6),
                             datum(site.latitude.value(), 6), datum(altitude_m, 2),
                             datum(station.gravity_mgal, 3), clean_utf8(site.name));
    }
    return lines;
}

/// Returns the two lines of a station's label as a text of gnuplot, and their greatest length.
std::pair<std::string, std::size_t> label_of(const MapStation& station) {
    const std::string visits =
        station.visits.empty() ? "" : fmt::format(" [{}]", text::joined(station.visits));
    const std::string name = short_label(station.site->name) + visits;
    std::string value = text::fixed(station.gravity_mgal, 2) + " mGal";
    if (station.site->has_altitude)
        value += fmt::format(", {} m", text::fixed(station.site->altitude.value(), 0));
    return {fmt::format("{}.\"\\n\".{}", gnuplot_string(name), gnuplot_string(value)),
            std::max(name.size(), value.size())};
}

}  // namespace

std::optional<Figure> map_figure(const model::SurveyCorrection& result,
                                 const std::vector<text::Site>& sites) {
    std::vector<MapStation> stations;
    std::vector<const text::Site*> places;
    std::string absent;
    for (const model::StationValue& station : result.stations) {
        const text::Site* const site = text::find_site(sites, station.site);
        if (site != nullptr && site->is_placed) {
            stations.push_back({site, station.gravity.value(), {}});
            places.push_back(site);
        } else {
            absent += (absent.empty() ? "" : ", ") + station.site;
        }
    }
    if (stations.empty()) return std::nullopt;
    const Frame frame = frame_around(places);
    std::string route;
    std::size_t visit = 0;
    for (const std::string& name : visited_sites(result)) {
        ++visit;
        const auto station = std::ranges::find(
            stations, name, [](const MapStation& candidate) { return candidate.site->name; });
        if (station == stations.end()) continue;
        station->visits.push_back(std::to_string(visit));
        route += fmt::format("{}{}{}\n", datum(station->site->longitude.value(), 6),
                             datum(station->site->latitude.value(), 6), visit);
    }

    FigureData data("map");
    std::vector<std::string> clauses;
    if (const std::string source = data.add("visits: longitude_deg latitude_deg number", route);
        !source.empty())
        clauses.push_back(source + " using 1:2 with lines lw 1 lc rgb '#bbbbbb' notitle");
    for (const bool is_known : {true, false}) {
        const std::string source =
            data.add(fmt::format("{} reference: longitude_deg latitude_deg altitude_m gravity_mgal",
                                 is_known ? "with" : "without"),
                     station_lines(stations, is_known));
        if (source.empty()) continue;
        clauses.push_back(
            fmt::format("{} using 1:2:4 with points {} palette title '{}'", source,
                        is_known ? "pt 7 ps 0.9" : "pt 9 ps 1.1",
                        is_known ? text::tr("known gravity") : text::tr("unknown gravity")));
    }
    LabelPlacer placer(frame, places);
    std::string labels;
    for (const MapStation& station : stations) {
        const auto [label, letter_count] = label_of(station);
        const LabelPlace place = placer.place(*station.site, letter_count);
        const double x = frame.x_px(station.site->longitude.value()) + place.x_px;
        const double y =
            frame.y_px(station.site->latitude.value()) + place.y_px + kLine_px / 2;  // first line
        labels += fmt::format("set label {} at graph {},{} {} font ',11' front\n", label,
                              text::fixed(x / kPlotWidth_px, 5), text::fixed(y / kPlotHeight_px, 5),
                              place.is_left ? "right" : "left");
    }
    const auto [least, greatest] = std::ranges::minmax(stations, {}, &MapStation::gravity_mgal);
    const double step_deg = round_step(frame.longitude.length() / 4.0);
    const int decimals = static_cast<int>(std::clamp(-std::floor(std::log10(step_deg)), 0.0, 6.0));
    const auto range = [](const Range& r) {
        return fmt::format("[{}:{}]", text::fixed(r.least, 7), text::fixed(r.greatest, 7));
    };
    return data.figure(
        text::tr("Stations with the order of the visits in brackets, gravity and height; the "
                 "scale is the same in both directions. Gravity of known stations is in sample; "
                 "its uncertainty u is in the table.") +
            (absent.empty() ? ""
                            : text::tr(" Not shown, because they have no position: {}.", absent)),
        kMapWidth_px, kMapHeight_px,
        fmt::format(
            "set lmargin at screen {}\nset rmargin at screen {}\nset bmargin at screen {}\n"
            "set tmargin at screen {}\nset xrange {}\nset yrange {}\nset xtics {}\nset ytics {}\n"
            "set format '%.{}f'\nset xlabel '{}'\nset ylabel '{}'\n"
            "set key inside bottom right\nset cblabel '{}'\nset cbrange [{}:{}]\n"
            "set format cb '%.0f'\n"
            "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 "
            "'#fde725')\n"
            "{}{}{}",
            text::fixed(kLeft, 2), text::fixed(kRight, 2), text::fixed(kBottom, 2),
            text::fixed(kTop, 2), range(frame.longitude), range(frame.latitude),
            text::fixed(step_deg, 7), text::fixed(step_deg, 7), decimals,
            text::tr("Longitude (° east)"), text::tr("Latitude (° north)"),
            text::tr("Gravity (mGal)"), text::fixed(least.gravity_mgal - 0.5, 3),
            text::fixed(greatest.gravity_mgal + 0.5, 3), bar(frame), labels,
            plot_command(clauses)));
}

}  // namespace a351::corrector::figure
