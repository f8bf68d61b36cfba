#include <array>
#include <cmath>

#include "corrector/tide/earth_tide.hpp"
#include "corrector/tide/lunar_terms.hpp"
#include "corrector/tide/meridian.hpp"
#include "corrector/tide/permanent_tide.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::tide {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

constexpr double kSecondsPerDay = 86400.0;
constexpr double kDaysPerCentury = 36525.0;
constexpr UtcTime kJ2000 =
    std::chrono::sys_days(std::chrono::year(2000) / 1 / 1) + std::chrono::hours(12);

/// TT - UTC, s: 32.184 s + TAI - UTC, with TAI - UTC of 30 to 37 s in 1996-2030, rounded.  Source:
/// IERS Bulletin C.
constexpr double kTtMinusUtc_s = 69.0;

/// GM, m3/s2.  Sources: Moon JPL ephemeris DE430 (W. M. Folkner et al., IPN Progress Report 42-196,
/// 2014); Sun DE405 (E. M. Standish, JPL IOM 312.F-98-048, 1998).
constexpr double kGmMoon = 4.902800066e12;
constexpr double kGmSun = 1.32712440018e20;

/// Astronomical unit, m.  Source: IAU 2012 resolution B2.
constexpr double kAstronomicalUnit_m = 149597870.7e3;

double sin_deg(double angle_deg) { return std::sin(angle_deg * kRadPerDeg); }
double cos_deg(double angle_deg) { return std::cos(angle_deg * kRadPerDeg); }

/// Geocentric position in ecliptic coordinates.
struct Ecliptic {
    double longitude_deg = 0.0;
    double latitude_deg = 0.0;
    double distance_m = 0.0;
};

/// Returns the position of the Moon: Meeus, ch. 47, with the terms of lunar_terms.hpp.
/// @param t  Julian centuries of TT from J2000.
Ecliptic moon_position(double t) {
    // Equations of Meeus without terms from t^3 on.
    const double mean_longitude =
        218.3164477 + 481267.88123421 * t - 0.0015786 * t * t;                    // L': 47.1
    const double d = 297.8501921 + 445267.1114034 * t - 0.0018819 * t * t;        // D: 47.2
    const double m = 357.5291092 + 35999.0502909 * t - 0.0001536 * t * t;         // M: 47.3
    const double m_prime = 134.9633964 + 477198.8675055 * t + 0.0087414 * t * t;  // M': 47.4
    const double f = 93.2720950 + 483202.0175233 * t - 0.0036539 * t * t;         // F: 47.5
    const double e = 1.0 - 0.002516 * t - 0.0000074 * t * t;                      // E: 47.6

    const auto angle = [&](const LunarArgument& a) {
        return a.d * d + a.m * m + a.m_prime * m_prime + a.f * f;
    };
    const auto scale = [&](const LunarArgument& a) { return std::pow(e, std::abs(a.m)); };

    // Longitude = L' + sum l, distance = 385000.56 km + sum r, latitude = sum b: tables 47.A, 47.B.
    double longitude_udeg = 0.0;
    double distance_m = 385000.56e3;
    for (const LongitudeDistanceTerm& term : kLongitudeDistanceTerms) {
        const double argument = angle(term.argument);
        longitude_udeg += scale(term.argument) * term.longitude_udeg * sin_deg(argument);
        distance_m += scale(term.argument) * term.distance_m * cos_deg(argument);
    }
    double latitude_udeg = 0.0;
    for (const LatitudeTerm& term : kLatitudeTerms)
        latitude_udeg += scale(term.argument) * term.latitude_udeg * sin_deg(angle(term.argument));
    return {mean_longitude + 1e-6 * longitude_udeg, 1e-6 * latitude_udeg, distance_m};
}

/// Returns the position of the Sun: Meeus, ch. 25, low accuracy (0.01 degree).
/// @param t  Julian centuries of TT from J2000.
Ecliptic sun_position(double t) {
    const double mean_longitude = 280.46646 + 36000.76983 * t + 0.0003032 * t * t;  // eq. 25.2
    const double m = 357.52911 + 35999.05029 * t - 0.0001537 * t * t;               // eq. 25.3
    const double eccentricity = 0.016708634 - 0.000042037 * t;  // eq. 25.4 without t^2
    // Equation of the centre, without the term in t^2 sin M.
    const double center = (1.914602 - 0.004817 * t) * sin_deg(m) +
                          (0.019993 - 0.000101 * t) * sin_deg(2.0 * m) +
                          0.000289 * sin_deg(3.0 * m);
    // Eq. 25.5.
    const double distance_au = 1.000001018 * (1.0 - eccentricity * eccentricity) /
                               (1.0 + eccentricity * cos_deg(m + center));
    return {mean_longitude + center, 0.0, distance_au * kAstronomicalUnit_m};
}

/// Returns the direction of a body as unit vector in the Earth-fixed frame: rotation from the
/// ecliptic to the equator by the obliquity, then about the pole by the sidereal angle.
Vector earth_fixed_direction(const Ecliptic& body, double obliquity_deg, double sidereal_deg) {
    const double x = cos_deg(body.latitude_deg) * cos_deg(body.longitude_deg);
    const double y = cos_deg(body.latitude_deg) * sin_deg(body.longitude_deg);
    const double z = sin_deg(body.latitude_deg);
    const double cos_o = cos_deg(obliquity_deg);
    const double sin_o = sin_deg(obliquity_deg);
    const double y_equator = y * cos_o - z * sin_o;
    const double z_equator = y * sin_o + z * cos_o;
    const double cos_s = cos_deg(sidereal_deg);
    const double sin_s = sin_deg(sidereal_deg);
    return {x * cos_s + y_equator * sin_s, y_equator * cos_s - x * sin_s, z_equator};
}

/// Position of a station in the Earth-fixed frame.
struct StationFrame {
    Vector direction;       ///< e: from the Earth's centre, unit length.
    Vector normal;          ///< n: outward normal of the ellipsoid, unit length.
    double radius_m = 0.0;  ///< r: distance from the Earth's centre.
};

StationFrame station_frame(const Station& station) {
    const double sin_lat = sin_deg(station.latitude.value());
    const double cos_lat = cos_deg(station.latitude.value());
    const double sin_lon = sin_deg(station.longitude.value());
    const double cos_lon = cos_deg(station.longitude.value());
    const auto [rho, z] = meridian(sin_lat, cos_lat, station.height.value());
    const double x = rho * cos_lon;
    const double y = rho * sin_lon;
    const double radius = std::sqrt(x * x + y * y + z * z);
    return {{x / radius, y / radius, z / radius},
            {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat},
            radius};
}

/// Returns degrees 2 and 3 of the tidal acceleration along the outward normal, m/s2:
/// A_k = GM/d^2 (r/d)^(k-1) [ (k P_k(c) - c P_k'(c)) (e.n) + P_k'(c) (u.n) ],   c = e.u
/// @param gm, distance_m, u  GM, distance and direction of the body.
double pull_mps2(double gm, double distance_m, const Vector& u, const StationFrame& at,
                 Factors factors) {
    const double c = dot(at.direction, u);
    const double e_n = dot(at.direction, at.normal);
    const double u_n = dot(u, at.normal);
    const double p2 = 1.5 * c * c - 0.5;        // P_2
    const double dp2 = 3.0 * c;                 // P_2'
    const double p3 = (2.5 * c * c - 1.5) * c;  // P_3
    const double dp3 = 7.5 * c * c - 1.5;       // P_3'
    const double ratio = at.radius_m / distance_m;
    const double a2 = ratio * ((2.0 * p2 - c * dp2) * e_n + dp2 * u_n);
    const double a3 = ratio * ratio * ((3.0 * p3 - c * dp3) * e_n + dp3 * u_n);
    return gm / (distance_m * distance_m) * (factors.delta2 * a2 + factors.delta3 * a3);
}

}  // namespace

MilliGal direct_tide(UtcTime time, const Station& station, Factors factors) {
    const double utc_days = seconds_between(kJ2000, time) / kSecondsPerDay;
    const double t = (utc_days + kTtMinusUtc_s / kSecondsPerDay) / kDaysPerCentury;
    const double t_ut = utc_days / kDaysPerCentury;
    // Mean obliquity: Meeus, eq. 22.2, linear part.
    const double obliquity_deg = 23.439291 - 0.0130042 * t;
    // Mean sidereal time at Greenwich: Meeus, eq. 12.4 without t^3.  UT1 - UTC (below 0.9 s)
    // changes the tide by at most 0.00002 mGal.
    const double sidereal_deg =
        280.46061837 + 360.98564736629 * utc_days + 0.000387933 * t_ut * t_ut;

    const StationFrame at = station_frame(station);
    const auto pull = [&](double gm, const Ecliptic& body) {
        return pull_mps2(gm, body.distance_m,
                         earth_fixed_direction(body, obliquity_deg, sidereal_deg), at, factors);
    };
    return MilliGal(-kMilliGalPerMps2 *
                    (pull(kGmMoon, moon_position(t)) + pull(kGmSun, sun_position(t))));
}

MilliGal earth_tide(Model model, UtcTime time, const Station& station, Factors factors,
                    System system) {
    if (model == Model::none) return MilliGal(0.0);
    const MilliGal whole = model == Model::direct ? direct_tide(time, station, factors)
                                                  : longman_tide(time, station, factors);
    return whole - kept_permanent_tide(system, station, factors);
}

}  // namespace a351::corrector::tide
