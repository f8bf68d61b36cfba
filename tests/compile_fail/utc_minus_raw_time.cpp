// Law: instants of different clocks have no difference.
#include "protocol/core/utc_time.hpp"

a351::Nanoseconds elapsed(a351::UtcTime from, a351::UtcTime to,
                          [[maybe_unused]] a351::RawTime raw) {
#ifdef A351_LEGAL
    return to - from;
#else
    return raw - from;
#endif
}
