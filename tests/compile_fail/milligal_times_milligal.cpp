// Law: the product of two accelerations is not an acceleration.
#include "protocol/core/units.hpp"

a351::MilliGal doubled(a351::MilliGal reading) {
#ifdef A351_LEGAL
    return 2.0 * reading;
#else
    return reading * reading;
#endif
}
