// Law: two instants cannot be added, only an instant and a duration.
#include "protocol/core/utc_time.hpp"

a351::UtcTime later(a351::UtcTime time, a351::Nanoseconds step) {
#ifdef A351_LEGAL
    return time + step;
#else
    return time + (time + step);
#endif
}
