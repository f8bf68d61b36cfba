// I. M. Longman, Formulas for computing the tidal accelerations due to the Moon and the Sun,
// J. Geophys. Res. 64(12), 2351-2355, 1959, doi:10.1029/JZ064i012p02351.  Symbols and units
// (centimetre, gram, second) are those of the paper; numbers in parentheses are its equations.
#include <cmath>

#include "corrector/tide/earth_tide.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::tide {
namespace {

constexpr double kSecondsPerCentury = 36525.0 * 86400.0;
/// Epoch of T: 1899-12-31 12:00.
constexpr UtcTime kEpoch =
    std::chrono::sys_days(std::chrono::year(1899) / 12 / 31) + std::chrono::hours(12);

constexpr double kGravitation = 6.673e-8;        // mu: constant of gravitation, cm3/(g s2)
constexpr double kMoonMass_g = 7.3537e25;        // M: mass of the Moon
constexpr double kSunMass_g = 1.993e33;          // S: mass of the Sun
constexpr double kMoonEccentricity = 0.05490;    // e: eccentricity of the Moon's orbit
constexpr double kMeanMotionRatio = 0.074804;    // m: mean motion of the Sun over that of the Moon
constexpr double kMoonInclination = 0.08979719;  // i: Moon's orbit to the ecliptic, rad
constexpr double kObliquity = 23.452 * kRadPerDeg;  // w: equator to the ecliptic, rad
constexpr double kMoonDistance_cm = 3.84402e10;     // c: mean distance of the Moon
constexpr double kSunDistance_cm = 1.495e13;        // c1: mean distance of the Sun
constexpr double kEarthRadius_cm = 6.378270e8;      // a: equatorial radius of the Earth

double square(double x) { return x * x; }

}  // namespace

MilliGal longman_tide(UtcTime time, const Station& station, Factors factors) {
    using std::cos;
    using std::sin;
    const double t = seconds_between(kEpoch, time) / kSecondsPerCentury;
    const double ut_hours =
        seconds_between(std::chrono::floor<std::chrono::days>(time), time) / 3600.0;

    // Mean longitudes of the Moon s (10), its perigee p (11), the Sun h (12), the Moon's ascending
    // node N (19) and the solar perigee p1 (26), rad; eccentricity e1 of the Earth's orbit (27).
    const double s = 4.720023434 + 8399.709299 * t + 4.40695e-5 * t * t + 3.29e-8 * t * t * t;
    const double p = 5.835124721 + 71.01800936 * t - 1.80546e-4 * t * t - 2.18e-7 * t * t * t;
    const double h = 4.88162798 + 628.33195099 * t + 5.27962e-6 * t * t;
    const double node = 4.523588570 - 33.757153303 * t + 3.67488e-5 * t * t + 3.87e-8 * t * t * t;
    const double p1 = 4.908229461 + 0.0300526416 * t + 7.902463e-6 * t * t + 5.81e-8 * t * t * t;
    const double e1 = 0.01675104 - 4.18e-5 * t - 1.26e-7 * t * t;
    const double e = kMoonEccentricity;
    const double m = kMeanMotionRatio;
    const double w = kObliquity;

    // Inclination I of the Moon's orbit to the equator (20):
    // cos I = cos w cos i - sin w sin i cos N.
    const double cos_i =
        cos(w) * cos(kMoonInclination) - sin(w) * sin(kMoonInclination) * cos(node);
    const double sin_i = std::sqrt(1.0 - cos_i * cos_i);
    // Longitude nu in the equator of its intersection A with the Moon's orbit (21):
    // sin nu = sin i sin N / sin I.
    const double sin_nu = sin(kMoonInclination) * sin(node) / sin_i;
    const double cos_nu = std::sqrt(1.0 - sin_nu * sin_nu);
    // xi = N - alpha: longitude of A in the orbit (14), with alpha from (15) and (16).
    // sigma = s - xi: mean longitude of the Moon from A (13).
    const double cos_alpha = cos(node) * cos_nu + sin(node) * sin_nu * cos(w);
    const double sin_alpha = sin(w) * sin(node) / sin_i;
    const double xi = node - std::atan2(sin_alpha, cos_alpha);
    const double nu = std::asin(sin_nu);
    const double sigma = s - xi;

    // Hour angle of the mean Sun (24); the paper counts longitudes to the west.
    const double hour_angle = (15.0 * (ut_hours - 12.0) + station.longitude.value()) * kRadPerDeg;
    // Right ascension of the station's meridian: chi from A (23), chi1 from the equinox (28).
    const double chi = hour_angle + h - nu;
    const double chi1 = hour_angle + h;
    // True longitudes: l of the Moon in its orbit from A (9), l1 of the Sun in the ecliptic (25).
    const double l = sigma + 2.0 * e * sin(s - p) + 1.25 * e * e * sin(2.0 * (s - p)) +
                     3.75 * m * e * sin(s - 2.0 * h + p) + 1.375 * m * m * sin(2.0 * (s - h));
    const double l1 = h + 2.0 * e1 * sin(h - p1);

    const double lat = station.latitude.value() * kRadPerDeg;
    // Zenith angles theta of the Moon (7) and phi of the Sun (8), which has w, l1, chi1 instead:
    // cos theta = sin lat sin I sin l
    //             + cos lat [cos^2(I/2) cos(l - chi) + sin^2(I/2) cos(l + chi)],
    // where cos^2(I/2) = (1 + cos I)/2 and sin^2(I/2) = (1 - cos I)/2.
    const double cos_theta =
        sin(lat) * sin_i * sin(l) +
        cos(lat) * (0.5 * (1.0 + cos_i) * cos(l - chi) + 0.5 * (1.0 - cos_i) * cos(l + chi));
    const double cos_phi =
        sin(lat) * sin(w) * sin(l1) +
        cos(lat) * (square(cos(0.5 * w)) * cos(l1 - chi1) + square(sin(0.5 * w)) * cos(l1 + chi1));

    // Distance from the Earth's centre (33), (34): r = a / sqrt(1 + 0.006738 sin^2 lat) + height.
    const double r = kEarthRadius_cm / std::sqrt(1.0 + 0.006738 * square(sin(lat))) +
                     100.0 * station.height.value();
    // a' = 1 / (c (1 - e^2)) (31), for the Sun (32); inverse distances 1/d of the Moon (29) and 1/D
    // of the Sun (30).
    const double a_moon = 1.0 / (kMoonDistance_cm * (1.0 - e * e));
    const double a_sun = 1.0 / (kSunDistance_cm * (1.0 - e1 * e1));
    const double inverse_d =
        1.0 / kMoonDistance_cm + a_moon * e * cos(s - p) + a_moon * e * e * cos(2.0 * (s - p)) +
        1.875 * a_moon * m * e * cos(s - 2.0 * h + p) + a_moon * m * m * cos(2.0 * (s - h));
    const double inverse_d1 = 1.0 / kSunDistance_cm + a_sun * e1 * cos(h - p1);

    // Upward pull of the Moon (1) and of the Sun (3):
    // mu M r/d^3 (3 cos^2 theta - 1) + 3/2 mu M r^2/d^4 (5 cos^3 theta - 3 cos theta)
    // + mu S r/D^3 (3 cos^2 phi - 1)
    const double moon = kGravitation * kMoonMass_g * r * inverse_d * inverse_d * inverse_d;
    const double sun = kGravitation * kSunMass_g * r * inverse_d1 * inverse_d1 * inverse_d1;
    const double degree2 =
        moon * (3.0 * square(cos_theta) - 1.0) + sun * (3.0 * square(cos_phi) - 1.0);
    const double degree3 = 1.5 * moon * r * inverse_d * (5.0 * square(cos_theta) - 3.0) * cos_theta;
    return MilliGal(-kMilliGalPerGal * (factors.delta2 * degree2 + factors.delta3 * degree3));
}

}  // namespace a351::corrector::tide
