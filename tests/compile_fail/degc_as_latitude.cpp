// Law: a temperature in degrees Celsius is not an angle in degrees.
#include "corrector/tide/earth_tide.hpp"

a351::corrector::tide::Station at_latitude([[maybe_unused]] a351::DegC temperature) {
#ifdef A351_LEGAL
    return {a351::Degrees(36.2), a351::Degrees(140.1), a351::Metres(400.0)};
#else
    return {temperature, a351::Degrees(140.1), a351::Metres(400.0)};
#endif
}
