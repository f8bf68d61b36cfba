// Law: a UTC instant is not an instant of the host's raw clock, which has another zero.
#include "protocol/timing/sample_clock.hpp"

void arrived(a351::timing::SampleClock& clock, a351::RawTime raw,
             [[maybe_unused]] a351::UtcTime utc) {
#ifdef A351_LEGAL
    clock.observe(0, raw);
#else
    clock.observe(0, utc);
#endif
}
