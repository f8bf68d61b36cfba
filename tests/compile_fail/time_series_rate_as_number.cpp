// Law: the rate of a time series has a unit: a period cannot be given by mistake.
#include "protocol/core/time_series.hpp"

a351::TimeSeries<a351::DegC> series(a351::UtcTime start, std::vector<double> values) {
#ifdef A351_LEGAL
    return {start, a351::Hertz(0.5), std::move(values)};
#else
    return {start, 2.0, std::move(values)};
#endif
}
