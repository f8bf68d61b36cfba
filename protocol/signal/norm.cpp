#include "protocol/signal/norm.hpp"

#include <cmath>
#include <stdexcept>

namespace a351::signal {
namespace {

bool same_grid(const TimeSeries<StandardGravity>& a, const TimeSeries<StandardGravity>& b) {
    return a.start() == b.start() && a.rate() == b.rate() && a.size() == b.size();
}

}  // namespace

TimeSeries<StandardGravity> norm(const TimeSeries<StandardGravity>& x,
                                 const TimeSeries<StandardGravity>& y,
                                 const TimeSeries<StandardGravity>& z) {
    if (!same_grid(x, y) || !same_grid(x, z))
        throw std::invalid_argument("norm: the axes must agree in start, rate and length");
    std::vector<double> values(x.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double a = x.values()[i];
        const double b = y.values()[i];
        const double c = z.values()[i];
        values[i] = std::sqrt(a * a + b * b + c * c);
    }
    return {x.start(), x.rate(), std::move(values)};
}

MilliGal rectification_bias(MilliGal rms_x, MilliGal rms_y, MilliGal gravity) {
    const double squares = rms_x.value() * rms_x.value() + rms_y.value() * rms_y.value();
    return MilliGal(squares / (2.0 * gravity.value()));
}

}  // namespace a351::signal
