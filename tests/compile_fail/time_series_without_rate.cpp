// Law: a TimeSeries cannot be made without its sampling rate, which gives the time axis.
#include "protocol/core/time_series.hpp"

a351::TimeSeries<a351::MilliGal> without_rate(a351::UtcTime start, std::vector<double> values) {
#ifdef A351_LEGAL
    return {start, a351::Hertz(50.0), std::move(values)};
#else
    return {start, std::move(values)};
#endif
}
