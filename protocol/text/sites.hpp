#pragma once
/// @file
/// The list of benchmarks and stations of a survey: position and reference gravity.
///
///     const std::vector<Site> sites = read_sites("sites.csv");
///     if (const Site* const base = find_site(sites, "No.0")) use(base->gravity);
///
/// The table has the columns that Site names, in any order; other columns are not used.  Its
/// rules are in corrector/result/table-format.md.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::text {

/// Most that the last digit of a gravity with an exponent may be worth, mGal.
inline constexpr double kMostOfLastDigit_mgal = 0.1;
/// Limits of a reference, mGal.  Gravity on the Earth's surface is 976 400 (Huascaran) to 983 400
/// mGal (Arctic Ocean).
inline constexpr double kLeastGravity_mgal = 976000.0, kGreatestGravity_mgal = 984000.0;

/// Limits of an altitude, m: mines reach 4000 m below the ground, which may be at sea level; Mount
/// Everest is at 8849.
inline constexpr double kLeastAltitude_m = -5000.0, kGreatestAltitude_m = 9000.0;

/// Benchmark, a row of `sites.csv`: site,longitude_deg,latitude_deg,altitude_m,gravity_mgal, and if
/// known u_gravity_mgal.
struct Site {
    /// Name as plain_text(), not empty and unique in its table.  Upper and lower case are different.
    std::string name;
    Degrees longitude;                ///< East, -180 to 360.
    Degrees latitude;                 ///< Geodetic, north.
    Metres altitude;                  ///< kLeastAltitude_m to kGreatestAltitude_m.
    std::optional<MilliGal> gravity;  ///< Reference value; absent for an unknown station.
    /// False if longitude or latitude was empty and is now the mean of the other sites.  The mean is
    /// good enough for a tide, which differs by less than 0.0001 mGal over a survey, but not for a
    /// map.
    bool is_placed = true;
    std::optional<MilliGal> u_gravity = {};  ///< Standard uncertainty of the reference, if given.
    bool has_altitude = true;  ///< False if the altitude was empty and is now such a mean.
};

/// Reads a table of sites; empty coordinates become the mean of the other sites.
///
/// Each column has a mean of its own, over the sites that give a number there.  It does not depend
/// on the order of the rows (sites_test.cpp).  Sites on both sides of the 180th meridian get a mean
/// between them, which can be below -180 degrees.
///
/// Limits: gravity 976 000 to 984 000 mGal, which finds a value in m/s2 or Gal; longitude, latitude
/// and altitude as in Site; an uncertainty 0 to 100 mGal.  An empty gravity is an unknown station.
/// @return the sites in the order of the file.  A header without rows gives an empty list, and its
///         columns are not checked.
/// @throws InputError  a column is missing, a number is not one or out of range, a coordinate is
///                     empty for every site, a site has no name, appears twice or is not UTF-8.
[[nodiscard]] std::vector<Site> read_sites(const std::filesystem::path& file);

/// Reads a table of sites from text in memory, as read_sites().
/// @param origin  file name shown in messages.
[[nodiscard]] std::vector<Site> parse_sites(std::string_view text,
                                            const std::filesystem::path& origin);

/// Returns why a site cannot have this name, in one line with the remedy; empty if it can.  A name
/// is UTF-8 without commas, control characters and blanks at its ends.
[[nodiscard]] std::string trouble_with_site_name(std::string_view name);

/// Returns the site of that name, or null.  The pointer is into `sites` and valid as long as the
/// list does not change.  The names are compared in turn, as plain_text().
[[nodiscard]] const Site* find_site(const std::vector<Site>& sites, std::string_view name);

/// Returns the distance of a site from a point, by the haversine formula on a sphere of 6371 km:
/// within 0.6 % of that on the ellipsoid.
[[nodiscard]] Metres distance(const Site& site, Degrees latitude, Degrees longitude);

/// Returns the site of that name, as find_site().
/// @throws InputError  if no site of the list has it.
[[nodiscard]] const Site& required_site(const std::vector<Site>& sites, const std::string& name);

/// Returns the only site whose name differs from a mistyped one in case, blanks or punctuation of
/// ASCII; null if there is none or more than one.  no.6 and NO 6 are like No.6.
[[nodiscard]] const Site* similar_site(const std::vector<Site>& sites, std::string_view name);

}  // namespace a351::text
