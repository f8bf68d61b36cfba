// Law: a number of seconds becomes a duration only through from_seconds().
#include "protocol/core/utc_time.hpp"

a351::Nanoseconds gap(double gap_s) {
#ifdef A351_LEGAL
    return a351::from_seconds(gap_s);
#else
    return gap_s;
#endif
}
