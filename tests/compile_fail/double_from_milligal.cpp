// Law: a value with a unit does not convert to a bare number; value() makes the loss of the unit
// visible.
#include "protocol/core/units.hpp"

double plotted(a351::MilliGal reading) {
#ifdef A351_LEGAL
    return reading.value();
#else
    return reading;
#endif
}
