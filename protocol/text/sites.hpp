#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::text {

/// Benchmark, a row of `sites.csv`: site,longitude_deg,latitude_deg,altitude_m,gravity_mgal.
struct Site {
    std::string name;
    Degrees longitude;  ///< East, -180 to 360.
    Degrees latitude;   ///< Geodetic, north.
    Metres altitude;
    std::optional<MilliGal> gravity;  ///< Reference value; absent for an unknown station.
    /// False if longitude, latitude or altitude was empty and is now the mean of the other sites.
    /// The mean is good enough for a tide, which differs by less than 0.0001 mGal over a survey,
    /// but not for a map.
    bool is_placed = true;
};

/// Reads a table of sites; empty coordinates become the mean of the other sites.
/// @throws InputError  a column is missing, a number is not one or out of range, a coordinate is
///                     empty for every site, a site has no name or appears twice.
[[nodiscard]] std::vector<Site> read_sites(const std::filesystem::path& file);

/// Returns the site of that name, or null.
[[nodiscard]] const Site* find_site(const std::vector<Site>& sites, std::string_view name);

}  // namespace a351::text
