#include "tests/support/plant_statistics.hpp"

#include <cmath>

namespace a351::sim {

double Figure::mean() const {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double Figure::deviation() const {
    const double middle = mean();
    double square = 0.0;
    for (const double value : values) square += (value - middle) * (value - middle);
    return values.size() < 2 ? 0.0 : std::sqrt(square / static_cast<double>(values.size() - 1));
}

}  // namespace a351::sim
