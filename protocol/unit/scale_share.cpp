#include <Eigen/Core>
#include <cmath>

#include "protocol/unit/calibration.hpp"

namespace a351::unit {

ScaleShare scale_share_of(const Faces& faces) {
    const double bias = faces.values(2), scale = faces.values(3), sum = bias + scale;
    const Eigen::Vector2d gradient(-scale, bias);  // of the share, times sum^2
    const double variance =
        gradient.dot(faces.covariance.bottomRightCorner<2, 2>() * gradient) / std::pow(sum, 4);
    const ScaleShare measured{scale / sum, std::sqrt(variance), true};
    return measured.deviation < ScaleShare{}.deviation ? measured : ScaleShare{};
}

}  // namespace a351::unit
