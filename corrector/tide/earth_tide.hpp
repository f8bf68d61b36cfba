#pragma once
/// @file
/// The tide of the solid Earth at a point: the effect on gravity of the attraction of Moon and Sun.
///
/// Sign: positive if gravity is larger, so that the reading is larger.  To remove the tide,
/// subtract it.
/// Not included: ocean loading, pole tide, air pressure (sizes: corrector/methods.md, "Tide").
///
/// Use direct_tide() for corrections, and longman_tide() to compare with programs that use those
/// formulas.  For a tide with ocean loading, or from another program, use Series.
///
///     const Station station{Degrees(36.216), Degrees(140.123), Metres(532.0)};
///     const MilliGal corrected = reading - direct_tide(middle_of_the_reading, station);
///
/// The magnitude is below 0.3 mGal everywhere.  All functions are pure: they allocate nothing,
/// throw nothing, and may be called from several threads.

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::tide {

/// A point on the Earth.
/// A default-constructed station is at latitude and longitude 0 on the ellipsoid.  The ranges are
/// not checked; angles are periodic.
struct Station {
    Degrees latitude;   ///< Geodetic latitude, WGS84, -90 to 90, north positive.
    Degrees longitude;  ///< Longitude, east positive; multiples of 360 degrees have no effect.
    /// Height above the ellipsoid.  A geoid height of 100 m changes the tide by less than 0.00001
    /// mGal.
    /// Negative heights are permitted.  Thus an altitude above sea level is good enough.
    Metres height;
};

/// Gravimetric factors: tide of the elastic Earth divided by that of a rigid Earth, by degree of
/// the potential.  The tide is linear in them (earth_tide_test.cpp).
/// Source: V. Dehant, P. Defraigne and J. M. Wahr, J. Geophys. Res. 104, 1035-1058, 1999.
/// Any finite factors are permitted, also 0; NaN gives NaN.
struct Factors {
    double delta2 = 1.16;  ///< Wahr-Dehant-Zschau model, rounded; 1.20 was usual in Japan.
    double delta3 = 1.07;  ///< Same for degree 3.

    bool operator==(const Factors&) const = default;
};

/// Limits of the factors.  Reason: no model of the Earth is outside them; 1 is a rigid Earth.
inline constexpr double kLeastFactor = 0.5, kGreatestFactor = 2.0;

/// Factors of a rigid Earth, without unit, for comparison with catalogues: attraction only.
inline constexpr Factors kRigidEarth{1.0, 1.0};

/// Factors of programs that follow Longman: 1 + h - 1.5 k with h = 0.612, k = 0.303.
/// They have no unit and are the same for both degrees; h and k are Love numbers.
inline constexpr Factors kLongmanFactors{1.1575, 1.1575};

/// Returns the tide from the positions of Moon and Sun: degrees 2 and 3 along the normal of the
/// ellipsoid.
///
///     tide = - sum over Moon, Sun of ( delta2 A_2 + delta3 A_3 )
///     A_k  = GM/d^2 (r/d)^(k-1) [ (k P_k(c) - c P_k'(c)) (e.n) + P_k'(c) (u.n) ],   c = e.u
///
/// d and u are distance and direction of the body, r and e those of the station from the Earth's
/// centre, n the outward normal of the WGS84 ellipsoid, P_k the Legendre polynomials.  The
/// permanent tide is included.
///
/// Nutation, aberration and UT1 - UTC are neglected; their effect is within the stated accuracy.
/// One value needs about a hundred sines and cosines.
///
/// Accuracy: 0.0001 mGal for a rigid Earth, 1995-2035 (tests/golden/tide/README.md).
/// tests/golden/tide_points_test.cpp checks this against a harmonic catalogue at eight points
/// between 2000 and 2029, and 1.16 times it within 0.0012 mGal against an elastic model.
/// tide_publication_test.cpp: 1.20 times it is within 0.0007 mGal of the publication's column.
/// Outside 1995-2035, TT - UTC drifts from the 69 s used here: 0.00001 mGal per 10 s.
/// @param time     UTC; for a mean over an interval, its middle.
/// @param station  finite; NaN gives NaN.
/// @param factors  gravimetric factors; kRigidEarth gives the tide of a rigid Earth.
/// @return mGal, positive if gravity is larger.
/// Source of the positions: lunar_terms.hpp; J. Meeus, Astronomical Algorithms, 2nd ed.,
/// Willmann-Bell 1998, ch. 12, 22, 25, 47.
[[nodiscard]] MilliGal direct_tide(UtcTime time, const Station& station, Factors factors = {});

/// Returns the tide by the closed formulas of I. M. Longman, J. Geophys. Res. 64, 2351-2355, 1959,
/// along the geocentric radius.  The sign is inverted: Longman's is an upward pull.
///
/// The Moon's attraction has degrees 2 and 3, the Sun's only degree 2.  The permanent tide is
/// included.
///
/// Accuracy: 0.0009 mGal rms, up to 0.0043 mGal against direct_tide(), rigid Earth, 0 to 70 degrees
/// north, each hour from 1995 to 2030.
/// tests/golden/tide_points_test.cpp: within 0.0016 mGal of the catalogue at eight points, and
/// within 0.00001 mGal of values computed from his formulas.  earth_tide_test.cpp: within 0.0025
/// mGal of direct_tide() over a month.
/// @param time     UTC.
/// @param station  finite; NaN gives NaN.  The height is added to the radius of his ellipsoid.
/// @param factors  gravimetric factors; the default is that of programs which follow Longman.
/// @return mGal, positive if gravity is larger.
[[nodiscard]] MilliGal longman_tide(UtcTime time, const Station& station,
                                    Factors factors = kLongmanFactors);

/// Models of the tide that are computed.
/// - `none`: no tide, 0 at all times, for readings that are corrected already.
/// - `direct`: direct_tide(), the default of a survey.
/// - `longman`: longman_tide(), for comparison; its error is up to 0.0043 mGal.
enum class Model { none, direct, longman };

/// Systems of gravity, by the part of the permanent tide that is removed from it.
/// - `tide_free`: all, attraction and deformation, with the factor delta2: the default, and the
///   systems of gravimeters that remove a tide themselves.
/// - `zero`: the attraction only; the Earth keeps its permanent deformation.  IAG resolution 16 of
///   1983 recommends it.
/// - `mean`: nothing; gravity as it is on the average.
enum class System { tide_free, zero, mean };

/// Returns the tide by one of the models; 0 for `none`.
/// @param time, station  as direct_tide().
/// @param factors         of either model; no model replaces them by defaults of its own.
/// @param system          of the gravity that remains if the result is subtracted.
/// @return mGal, positive if gravity is larger.
[[nodiscard]] MilliGal earth_tide(Model model, UtcTime time, const Station& station,
                                  Factors factors, System system = System::tide_free);

}  // namespace a351::corrector::tide
