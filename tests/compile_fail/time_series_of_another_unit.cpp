// Law: a series of temperatures is not a series of accelerations.
#include "protocol/core/time_series.hpp"

a351::TimeSeries<a351::MilliGal> trend(
    [[maybe_unused]] const a351::TimeSeries<a351::DegC>& temperature,
    const a351::TimeSeries<a351::MilliGal>& acceleration) {
#ifdef A351_LEGAL
    return acceleration;
#else
    return temperature;
#endif
}
