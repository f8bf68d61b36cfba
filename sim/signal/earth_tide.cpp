#include "sim/signal/earth_tide.hpp"

#include <chrono>
#include <cmath>

namespace a351::sim::signal {
namespace {

// Longman's table 1: centimetre, gram, second.
constexpr double kNewton = 6.673e-8;
constexpr double kMoonMass = 7.3537e25;
constexpr double kSunMass = 1.993e33;
constexpr double kMoonDistance = 3.84402e10;
constexpr double kSunDistance = 1.495e13;
constexpr double kEarthRadius = 6.378270e8;
constexpr double kMoonEccentricity = 0.05490;
constexpr double kMotionRatio = 0.074804;        ///< Mean motion of the Sun divided by the Moon's.
constexpr double kMoonInclination = 0.08979719;  ///< To the ecliptic.
constexpr double kObliquity = 23.452 * kRadPerDeg;

/// Returns the cosine of the zenith angle of a body at `longitude` in an orbit inclined by
/// `inclination`.
double cos_zenith(double latitude, double inclination, double longitude, double hour_angle) {
    const double c = std::cos(inclination / 2.0);
    const double s = std::sin(inclination / 2.0);
    return std::sin(latitude) * std::sin(inclination) * std::sin(longitude) +
           std::cos(latitude) * (c * c * std::cos(longitude - hour_angle) +
                                 s * s * std::cos(longitude + hour_angle));
}

}  // namespace

MilliGal earth_tide(Degrees latitude, Degrees longitude, Metres height, UtcTime time,
                    double factor) {
    using std::cos, std::sin;
    constexpr UtcTime kEpoch{std::chrono::sys_days{std::chrono::year{1899} / 12 / 31} +
                             std::chrono::hours{12}};
    const double T = seconds_between(kEpoch, time) / (86400.0 * 36525.0);
    const auto midnight = std::chrono::floor<std::chrono::days>(time);
    const double ut_hours = seconds_between(midnight, time) / 3600.0;

    // Mean longitudes of Moon and Sun, of their perigees and of the Moon's node (equations 10-12,
    // 19, 26).
    const double s = 4.720023434 + T * (8399.709299 + T * (4.40695e-5 + T * 3.29e-8));
    const double p = 5.835124721 + T * (71.01800936 + T * (-1.80546e-4 - T * 2.18e-7));
    const double h = 4.88162798 + T * (628.33195099 + T * 5.27962e-6);
    const double N = 4.523588570 + T * (-33.757153303 + T * (3.67488e-5 + T * 3.87e-8));
    const double p1 = 4.908229461 + T * (0.0300526416 + T * (7.902463e-6 + T * 5.81e-8));
    const double e1 = 0.01675104 + T * (-4.18e-5 - T * 1.26e-7);
    const double e = kMoonEccentricity;
    const double m = kMotionRatio;
    const double w = kObliquity;

    // The Moon's orbit relative to the equator.
    const double I =
        std::acos(cos(w) * cos(kMoonInclination) - sin(w) * sin(kMoonInclination) * cos(N));
    const double nu = std::asin(sin(kMoonInclination) * sin(N) / sin(I));
    const double alpha =
        std::atan2(sin(w) * sin(N) / sin(I), cos(N) * cos(nu) + sin(N) * sin(nu) * cos(w));
    const double sigma = s - (N - alpha);

    const double t = (15.0 * (ut_hours - 12.0) + longitude.value()) * kRadPerDeg;
    const double moon_longitude = sigma + 2.0 * e * sin(s - p) + 1.25 * e * e * sin(2.0 * (s - p)) +
                                  3.75 * m * e * sin(s - 2.0 * h + p) +
                                  1.375 * m * m * sin(2.0 * (s - h));
    const double sun_longitude = h + 2.0 * e1 * sin(h - p1);
    const double phi = latitude.value() * kRadPerDeg;
    const double moon_zenith = cos_zenith(phi, I, moon_longitude, t + h - nu);
    const double sun_zenith = cos_zenith(phi, w, sun_longitude, t + h);

    const double r =
        kEarthRadius / std::sqrt(1.0 + 0.006738 * sin(phi) * sin(phi)) + 100.0 * height.value();
    const double moon_a = 1.0 / (kMoonDistance * (1.0 - e * e));
    const double sun_a = 1.0 / (kSunDistance * (1.0 - e1 * e1));
    const double moon_inverse =
        1.0 / kMoonDistance +
        moon_a * (e * cos(s - p) + e * e * cos(2.0 * (s - p)) +
                  1.875 * m * e * cos(s - 2.0 * h + p) + m * m * cos(2.0 * (s - h)));
    const double sun_inverse = 1.0 / kSunDistance + sun_a * e1 * cos(h - p1);
    const double moon_cube = moon_inverse * moon_inverse * moon_inverse;
    const double moon_cos2 = moon_zenith * moon_zenith;
    const double up_gal = kNewton * kMoonMass * r * moon_cube * (3.0 * moon_cos2 - 1.0) +
                          1.5 * kNewton * kMoonMass * r * r * moon_cube * moon_inverse *
                              moon_zenith * (5.0 * moon_cos2 - 3.0) +
                          kNewton * kSunMass * r * sun_inverse * sun_inverse * sun_inverse *
                              (3.0 * sun_zenith * sun_zenith - 1.0);
    return MilliGal(-1000.0 * factor * up_gal);
}

}  // namespace a351::sim::signal
