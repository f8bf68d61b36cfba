// Law: a signal source cannot be copied, because its parts refer to its scenario.
#include "sim/signal/signal_source.hpp"

void use(a351::sim::signal::Source& signal) {
#ifdef A351_LEGAL
    a351::sim::signal::Source& same = signal;
#else
    a351::sim::signal::Source same = signal;
#endif
    static_cast<void>(same);
}
