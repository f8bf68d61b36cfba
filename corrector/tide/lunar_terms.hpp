#pragma once
/// @file
/// Periodic terms of the Moon's longitude, distance and latitude.
/// Source: J. Meeus, Astronomical Algorithms, 2nd ed., Willmann-Bell 1998, ch. 47, tables 47.A and
/// 47.B, which shorten the theory ELP-2000/82 of M. Chapront-Touze and J. Chapront.
///
/// The tables are data of direct_tide().  Use them elsewhere only if an error of the Moon's
/// position of this size is small enough:
///
///     longitude = L' + sum of longitude_udeg 1e-6 E^|m| sin(argument)        degrees
///     distance  = 385000560 m + sum of distance_m E^|m| cos(argument)
///     latitude  = sum of latitude_udeg 1e-6 E^|m| sin(argument)              degrees
///     argument  = d D + m M + m_prime M' + f F
///
/// L' is the mean longitude of the Moon, and E the eccentricity factor of the Earth's orbit (eq.
/// 47.6).  The result refers to the mean ecliptic and equinox of date.  Meeus's additive terms for
/// Venus, Jupiter and the flattening of the Earth are left out too.
///
/// The same numbers are in tests/golden/tide/lunar_terms.csv.

#include <array>

namespace a351::corrector::tide {

/// Multiples of the fundamental arguments in the argument of a term.  A term is multiplied by
/// E^|m|.
/// A default-constructed argument is 0: its sine is 0, and its cosine is 1.
struct LunarArgument {
    int d = 0;        ///< Multiple of D, mean elongation of the Moon.
    int m = 0;        ///< Multiple of M, mean anomaly of the Sun.
    int m_prime = 0;  ///< Multiple of M', mean anomaly of the Moon.
    int f = 0;        ///< Multiple of F, argument of latitude of the Moon.
};

/// A row of table 47.A.
/// One argument serves both sums.  A coefficient of 0 means that the table has none there.
struct LongitudeDistanceTerm {
    LunarArgument argument;
    double longitude_udeg = 0.0;  ///< Coefficient of the sine, 1e-6 degree.
    double distance_m = 0.0;      ///< Coefficient of the cosine, m.
};

/// A row of table 47.B.
struct LatitudeTerm {
    LunarArgument argument;
    double latitude_udeg = 0.0;  ///< Coefficient of the sine, 1e-6 degree.
};

/// 31 terms of table 47.A.  All terms that are left out change the tide together by less than
/// 0.0001 mGal.  Test: the accuracy of direct_tide().
///
/// The terms are in order of their longitude coefficients.  They are the first 32 rows of the table
/// without {2, 0, -1, 2}, which has -2602e-6 degree in longitude and nothing in distance.  They are
/// not the largest in distance: the last row, {2, 0, -1, -2} with 8752 m, is left out too.
inline constexpr std::array<LongitudeDistanceTerm, 31> kLongitudeDistanceTerms{{
    {{0, 0, 1, 0}, 6288774.0, -20905355.0}, {{2, 0, -1, 0}, 1274027.0, -3699111.0},
    {{2, 0, 0, 0}, 658314.0, -2955968.0},   {{0, 0, 2, 0}, 213618.0, -569925.0},
    {{0, 1, 0, 0}, -185116.0, 48888.0},     {{0, 0, 0, 2}, -114332.0, -3149.0},
    {{2, 0, -2, 0}, 58793.0, 246158.0},     {{2, -1, -1, 0}, 57066.0, -152138.0},
    {{2, 0, 1, 0}, 53322.0, -170733.0},     {{2, -1, 0, 0}, 45758.0, -204586.0},
    {{0, 1, -1, 0}, -40923.0, -129620.0},   {{1, 0, 0, 0}, -34720.0, 108743.0},
    {{0, 1, 1, 0}, -30383.0, 104755.0},     {{2, 0, 0, -2}, 15327.0, 10321.0},
    {{0, 0, 1, 2}, -12528.0, 0.0},          {{0, 0, 1, -2}, 10980.0, 79661.0},
    {{4, 0, -1, 0}, 10675.0, -34782.0},     {{0, 0, 3, 0}, 10034.0, -23210.0},
    {{4, 0, -2, 0}, 8548.0, -21636.0},      {{2, 1, -1, 0}, -7888.0, 24208.0},
    {{2, 1, 0, 0}, -6766.0, 30824.0},       {{1, 0, -1, 0}, -5163.0, -8379.0},
    {{1, 1, 0, 0}, 4987.0, -16675.0},       {{2, -1, 1, 0}, 4036.0, -12831.0},
    {{2, 0, 2, 0}, 3994.0, -10445.0},       {{4, 0, 0, 0}, 3861.0, -11650.0},
    {{2, 0, -3, 0}, 3665.0, 14403.0},       {{0, 1, -2, 0}, -2689.0, -7003.0},
    {{2, -1, -2, 0}, 2390.0, 10056.0},      {{1, 0, 1, 0}, -2348.0, 6322.0},
    {{2, -2, 0, 0}, 2236.0, -9884.0},
}};

/// The 14 largest terms of table 47.B, in order of magnitude.  The largest one that is left out has
/// 2463e-6 degree.
inline constexpr std::array<LatitudeTerm, 14> kLatitudeTerms{{
    {{0, 0, 0, 1}, 5128122.0},
    {{0, 0, 1, 1}, 280602.0},
    {{0, 0, 1, -1}, 277693.0},
    {{2, 0, 0, -1}, 173237.0},
    {{2, 0, -1, 1}, 55413.0},
    {{2, 0, -1, -1}, 46271.0},
    {{2, 0, 0, 1}, 32573.0},
    {{0, 0, 2, 1}, 17198.0},
    {{2, 0, 1, -1}, 9266.0},
    {{0, 0, 2, -1}, 8822.0},
    {{2, -1, 0, -1}, 8216.0},
    {{2, 0, -2, -1}, 4324.0},
    {{2, 0, 1, 1}, 4200.0},
    {{2, 1, 0, -1}, -3359.0},
}};

}  // namespace a351::corrector::tide
