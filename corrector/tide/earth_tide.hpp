#pragma once
/// @file
/// The tide of the solid Earth at a point: the effect on gravity of the attraction of Moon and Sun.
/// Positive means that gravity is larger and the reading goes up; to remove the tide, subtract it.
/// Ocean loading, pole tide and air pressure are not included.

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

struct TideStation {
    Degrees latitude;   ///< Geodetic, WGS84, north positive.
    Degrees longitude;  ///< East positive; any multiple of 360 degrees may be added.
    Metres height;  ///< Above the ellipsoid; 100 m of geoid height change less than 0.00001 mGal.
};

/// Gravimetric factors: tide of the elastic Earth / tide of a rigid one, by degree of the potential.
struct TideFactors {
    double delta2 = 1.16;  ///< Wahr-Dehant-Zschau model, rounded; 1.20 was customary in Japan.
    double delta3 = 1.07;  ///< The same for degree 3.
};

inline constexpr TideFactors kRigidEarth{1.0, 1.0};

/// 1 + h - 1.5 k with h = 0.612, k = 0.303, usual in programs that follow Longman.
inline constexpr TideFactors kLongmanFactors{1.1575, 1.1575};

/// Tide from the positions of Moon and Sun: degrees 2 and 3 along the normal of the ellipsoid.
///
///     tide = - sum over Moon, Sun of ( delta2 A_2 + delta3 A_3 )
///     A_k  = GM/d^2 (r/d)^(k-1) [ (k P_k(c) - c P_k'(c)) (e.n) + P_k'(c) (u.n) ],   c = e.u
///
/// d distance and u direction of the body, r and e those of the station, n the ellipsoid's normal.
/// The permanent tide is included.
///
/// Accuracy: 0.0001 mGal for a rigid Earth, 1995-2035 (tide_points_test.cpp: eight points against
/// a harmonic catalogue); outside, TT - UTC drifts from the 69 s used here, 0.00001 mGal per 10 s.
/// Source of the positions: lunar_terms.hpp; J. Meeus, Astronomical Algorithms, 2nd ed., ch. 25.
[[nodiscard]] MilliGal direct_tide(UtcTime time, const TideStation& station,
                                   TideFactors factors = {});

/// Tide by the closed formulas of I. M. Longman, J. Geophys. Res. 64, 2351-2355, 1959, with the sign
/// turned round: his is an upward pull.  Along the geocentric radius.
///
/// Accuracy: 0.0008 mGal rms, 0.0025 mGal at most against a catalogue, rigid Earth.
[[nodiscard]] MilliGal longman_tide(UtcTime time, const TideStation& station,
                                    TideFactors factors = kLongmanFactors);

enum class TideModel { none, direct, longman };

/// The tide by one of the models; zero for `none`.
[[nodiscard]] MilliGal earth_tide(TideModel model, UtcTime time, const TideStation& station,
                                  TideFactors factors);

}  // namespace a351::corrector
