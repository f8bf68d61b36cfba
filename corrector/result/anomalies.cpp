#include "corrector/result/anomalies.hpp"

#include "corrector/reduction/plate_and_pressure.hpp"
#include "protocol/core/normal_gravity.hpp"

namespace a351::corrector::result {

void add_anomalies(std::vector<model::StationValue>& stations, const std::vector<text::Site>& sites,
                   double density_kg_per_m3) {
    for (model::StationValue& station : stations) {
        const text::Site* const site = text::find_site(sites, station.site);
        if (site == nullptr || !site->is_placed || !site->has_altitude) continue;
        model::Anomalies& anomalies = station.anomalies.emplace();
        anomalies.normal_gravity = a351::normal_gravity(site->latitude);
        anomalies.free_air = station.gravity - a351::normal_gravity(site->latitude, site->altitude);
        anomalies.bouguer =
            anomalies.free_air - reduction::bouguer_plate(site->altitude, density_kg_per_m3);
    }
}

}  // namespace a351::corrector::result
