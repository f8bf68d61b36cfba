#include "protocol/linear_algebra/pivoted_qr.hpp"

#include <Eigen/QR>

namespace a351::linear_algebra {

struct PivotedQr::Decomposition {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
};

PivotedQr::PivotedQr(const Eigen::MatrixXd& matrix)
    : decomposition_(std::make_unique<Decomposition>(
          Decomposition{Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(matrix)})) {}
PivotedQr::~PivotedQr() = default;

Eigen::VectorXd PivotedQr::pivots() const {
    return decomposition_->qr.matrixR().diagonal().cwiseAbs();
}

Eigen::Index PivotedQr::rank() const { return decomposition_->qr.rank(); }

Eigen::VectorXd PivotedQr::solve(const Eigen::VectorXd& right) const {
    return decomposition_->qr.solve(right);
}

Eigen::MatrixXd PivotedQr::cofactor_root() const {
    const auto& qr = decomposition_->qr;
    const Eigen::Index p = qr.cols();
    const Eigen::MatrixXd inverse_r =
        qr.matrixR().topLeftCorner(p, p).triangularView<Eigen::Upper>().solve(
            Eigen::MatrixXd::Identity(p, p));
    return qr.colsPermutation() * inverse_r;
}

}  // namespace a351::linear_algebra
