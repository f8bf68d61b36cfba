#pragma once
/// @file
/// Gravity anomalies of the stations of a survey.

#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::result {

/// Sets normal gravity and anomalies of the stations whose latitude and altitude are known:
///
///     free air = gravity - gamma(latitude, altitude)
///     Bouguer  = free air - 2 pi G density altitude
///
/// gravity is StationValue::gravity, and altitude that of the table of sites, taken as above sea
/// level.  Formulas and accuracy: protocol/core/normal_gravity.hpp.
/// @param density_kg_per_m3  of the plate, reduction::kLeastDensity_kg_per_m3 to
///                           kGreatestDensity_kg_per_m3; not checked.
void add_anomalies(std::vector<model::StationValue>& stations, const std::vector<text::Site>& sites,
                   double density_kg_per_m3);

}  // namespace a351::corrector::result
