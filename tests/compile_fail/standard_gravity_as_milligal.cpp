// Law: an acceleration in g becomes mGal only through to_milligal().
#include "protocol/core/units.hpp"

a351::MilliGal vertical(a351::StandardGravity z) {
#ifdef A351_LEGAL
    return a351::to_milligal(z);
#else
    return z;
#endif
}
