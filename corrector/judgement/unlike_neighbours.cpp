#include "corrector/judgement/unlike_neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "corrector/judgement/reading_name.hpp"
#include "corrector/reduction/plate_and_pressure.hpp"
#include "protocol/core/normal_gravity.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::judgement {
namespace {

constexpr double kFar_mgal = 40.0, kFits_mgal = 20.0;
/// Excess of the plate over a cone of rock at its top, 2 pi G rho sin(slope), for slopes of 27 deg.
constexpr double kTerrain_mgal_per_m = 0.05;
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

/// How a gravity compares with those of the neighbours of a site.
struct Compared {
    double off_mgal = 0.0;      ///< 0 with too few neighbours.
    double terrain_mgal = 0.0;  ///< Difference that a summit or a valley explains.
};

/// @param without  a station that is no neighbour.
Compared compare(const std::vector<Placed>& stations, const text::Site& site, MilliGal gravity,
                 const text::Site& without) {
    std::vector<double> anomalies_mgal, heights_m;
    for (const Placed& other : stations) {
        if (other.site == &without ||
            !(text::distance(*other.site, site.latitude, site.longitude) < kNear))
            continue;
        anomalies_mgal.push_back(other.anomaly_mgal);
        heights_m.push_back(other.site->altitude.value());
    }
    if (anomalies_mgal.size() < kFewestNeighbours) return {};
    const double above_m = site.altitude.value() - signal::median(std::move(heights_m));
    return {anomaly_mgal(site, gravity) - signal::median(std::move(anomalies_mgal)),
            kTerrain_mgal_per_m * std::abs(above_m)};
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
        const auto [off_mgal, terrain_mgal] = compare(stations, *site, station.gravity, *site);
        if (std::abs(off_mgal) <= std::max(kFar_mgal, terrain_mgal)) continue;
        std::vector<std::string> fitting;
        for (const text::Site& other : sites) {
            if (!has_height(other) || result.station(other.name) != nullptr) continue;
            const double off = compare(stations, other, station.gravity, *site).off_mgal;
            if (off != 0.0 && std::abs(off) < kFits_mgal) fitting.push_back(other.name);
        }
        const auto row = std::ranges::find_if(result.rows, [&](const model::CorrectedRow& one) {
            return one.row.site == station.site && !one.row.is_excluded;
        });
        if (row == result.rows.end()) continue;
        reading::Finding& finding = findings.emplace_back(reading::Finding{
            .kind = reading::FindingKind::other_name, .code = kUnlikeNeighboursCode});
        set_stay(finding, row->row);
        finding.size_mgal = off_mgal;
        finding.text = text::message(
            "{} is {} mGal from what its height suggests beside its neighbours: check its name, "
            "position and height, if it is no summit or mine",
            stay_name(row->row), text::fixed(off_mgal, 0));
        if (fitting.size() != 1) continue;
        finding.other_site = fitting.front();
        finding.text += text::message("; it would fit {}", finding.other_site);
        const reading::SurveyRow* before = nullptr;
        for (const model::CorrectedRow& one : result.rows) {
            if (one.row.site != station.site || one.row.is_excluded) continue;
            if (before == nullptr || before->occupation != one.row.occupation)
                finding.amendment +=
                    reading::rename_amendment(one.row, finding.other_site, "its height fits");
            before = &one.row;
        }
    }
    return findings;
}

}  // namespace a351::corrector::judgement
