// Law: values of different units cannot be compared.
#include "protocol/core/units.hpp"

bool exceeds(a351::MilliGal reading, [[maybe_unused]] a351::DegC limit) {
#ifdef A351_LEGAL
    return reading > a351::MilliGal(1.0);
#else
    return reading > limit;
#endif
}
