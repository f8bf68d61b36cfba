#include "corrector/judgement/unlike_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "corrector/judgement/reading_name.hpp"
#include "corrector/reduction/plate_and_pressure.hpp"
#include "protocol/core/normal_gravity.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::judgement {
namespace {

constexpr double kFar_mgal = 40.0, kFits_mgal = 20.0;
constexpr Metres kNear(20e3);
constexpr std::size_t kFewestNeighbours = 4;
constexpr MilliGal kGreatestU(10.0);

/// A station with a place.
struct Placed {
    const text::Site* site = nullptr;
    double anomaly_mgal = 0.0;
};

/// Returns the gravity without that of the normal Earth and of the rock below the site.
double anomaly_mgal(const text::Site& site, MilliGal gravity) {
    return (gravity - normal_gravity(site.latitude, site.altitude) -
            reduction::bouguer_plate(site.altitude, reduction::kCrust_kg_per_m3))
        .value();
}

/// Returns an anomaly minus the median of the neighbours of a site; NaN with too few of them.
double off_neighbours_mgal(const std::vector<Placed>& stations, const text::Site& site,
                           double anomaly_mgal, const text::Site& without) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> near;
    for (const Placed& other : stations)
        if (other.site != &without &&
            text::distance(*other.site, site.latitude, site.longitude) < kNear)
            near.push_back(other.anomaly_mgal);
    return near.size() < kFewestNeighbours ? kUnknown
                                           : anomaly_mgal - signal::median(std::move(near));
}

bool has_height(const text::Site& site) { return site.is_placed && site.has_altitude; }

}  // namespace

std::vector<reading::Finding> unlike_neighbours(const model::SurveyCorrection& result,
                                                const std::vector<text::Site>& sites) {
    std::vector<Placed> stations;
    for (const model::StationValue& station : result.stations)
        if (const text::Site* const site = text::find_site(sites, station.site);
            site != nullptr && has_height(*site))
            stations.push_back(
                {site, anomaly_mgal(*site, station.reference.value_or(station.gravity))});
    std::vector<reading::Finding> findings;
    for (const model::StationValue& station : result.stations) {
        const text::Site* const site = text::find_site(sites, station.site);
        if (site == nullptr || !has_height(*site) || station.reference ||
            station.u_gravity.value_or(MilliGal(0.0)) > kGreatestU)
            continue;
        const double off_mgal =
            off_neighbours_mgal(stations, *site, anomaly_mgal(*site, station.gravity), *site);
        if (!(std::abs(off_mgal) > kFar_mgal)) continue;
        std::vector<std::string> fitting;
        for (const text::Site& other : sites)
            if (has_height(other) &&
                std::ranges::find(result.stations, other.name, &model::StationValue::site) ==
                    result.stations.end() &&
                std::abs(off_neighbours_mgal(stations, other, anomaly_mgal(other, station.gravity),
                                             *site)) < kFits_mgal)
                fitting.push_back(other.name);
        const auto row = std::ranges::find_if(result.rows, [&](const model::CorrectedRow& one) {
            return one.row.site == station.site;
        });
        reading::Finding& finding = findings.emplace_back(reading::Finding{
            .kind = reading::FindingKind::other_name, .code = kUnlikeNeighboursCode});
        set_stay(finding, row->row, row->row.start.value_or(row->row.time));
        finding.size_mgal = off_mgal;
        finding.text = text::message(
            "{} is {} mGal from what its height suggests beside its neighbours: check its name, "
            "position and height",
            stay_name(row->row), text::fixed(off_mgal, 0));
        if (fitting.size() != 1) continue;
        finding.other_site = fitting.front();
        finding.text += text::message("; it would fit {}", finding.other_site);
        finding.amendment =
            reading::rename_amendment(row->row, finding.other_site, "its height fits");
    }
    return findings;
}

}  // namespace a351::corrector::judgement
