// Law: a number without a unit does not convert to MilliGal.
#include "protocol/core/units.hpp"

a351::MilliGal drift() {
#ifdef A351_LEGAL
    return a351::MilliGal(1.5);
#else
    return 1.5;
#endif
}
