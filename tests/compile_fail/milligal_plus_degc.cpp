// Law: values of different units cannot be added.
#include "protocol/core/units.hpp"

a351::MilliGal corrected(a351::MilliGal reading, [[maybe_unused]] a351::DegC temperature) {
#ifdef A351_LEGAL
    return reading + a351::MilliGal(1.0);
#else
    return reading + temperature;
#endif
}
