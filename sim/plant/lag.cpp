#include "sim/plant/lag.hpp"

#include <cmath>

namespace a351::sim::plant {

Lag::Lag(double tau_s, double step_s, double degc)
    : keep_(std::exp(-step_s / tau_s)),
      of_rise_(1.0 - (1.0 - keep_) * tau_s / step_s),
      degc_(degc) {}

double Lag::next(double from_degc, double to_degc) noexcept {
    degc_ = keep_ * degc_ + (1.0 - keep_) * from_degc + of_rise_ * (to_degc - from_degc);
    return degc_;
}

}  // namespace a351::sim::plant
