#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::text {

/// A benchmark of `sites.csv`: site,longitude_deg,latitude_deg,altitude_m,gravity_mgal.
struct Site {
    std::string name;
    Degrees longitude;  ///< East, -180 to 360.
    Degrees latitude;   ///< Geodetic, north.
    Metres altitude;
    std::optional<MilliGal> gravity;  ///< Reference value; absent for an unknown station.
    /// False: of longitude, latitude and altitude what was empty is the mean of the other sites'.
    /// Good enough for a tide, which over a survey differs by less than 0.0001 mGal; for no map.
    bool is_placed = true;
};

/// @throws InputError  a column is missing, a number is not one, a coordinate is empty for every
///                     site, a site has no name or stands twice.
[[nodiscard]] std::vector<Site> read_sites(const std::filesystem::path& file);

/// The site of that name, or null.
[[nodiscard]] const Site* find_site(const std::vector<Site>& sites, std::string_view name);

}  // namespace a351::text
