#include "corrector/adjustment/dense_residuals.hpp"

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <utility>

namespace a351::corrector::adjustment {
namespace {

using Index = Eigen::Index;

/// Least length of an effect that is left, relative to the whole effect.  Reason: below it the
/// uncertainty of its size is 1000 times that of the readings: nothing can be said about it.
constexpr double kLeastLeft = 1e-3;

double sum_over(const Eigen::MatrixXd& matrix, const Effect& a, const Effect& b) {
    double sum = 0.0;
    for (const std::size_t i : a)
        for (const std::size_t k : b) sum += matrix(static_cast<Index>(i), static_cast<Index>(k));
    return sum;
}

class EffectsOn final : public Residuals {
public:
    explicit EffectsOn(DenseResiduals residuals)
        : residuals_(std::move(residuals)), effects_(residuals_.whitening) {
        effects_ -= residuals_.unknown * (residuals_.unknown.transpose() * effects_);
        whole_ = residuals_.whitening.transpose() * residuals_.whitening;
        information_ = effects_.transpose() * effects_;
        scatters_ = residuals_.to_scatter * effects_;
        scattered_ = scatters_.transpose() * scatters_;
        dof_ = residuals_.dof();
        seen_ = seen_of(residuals_.values);
    }

    [[nodiscard]] const Seen& seen() const override { return seen_; }
    [[nodiscard]] double dof() const override { return dof_; }
    [[nodiscard]] Seen simulated(std::mt19937_64& generator) const override {
        return seen_of(residuals_.simulated(generator));
    }
    [[nodiscard]] double information(const Effect& a, const Effect& b) const override {
        return sum_over(information_, a, b);
    }
    [[nodiscard]] double whole(const Effect& d) const override { return sum_over(whole_, d, d); }
    [[nodiscard]] double scattered(const Effect& a, const Effect& b) const override {
        return sum_over(scattered_, a, b);
    }
    [[nodiscard]] bool is_plain() const override { return false; }

private:
    [[nodiscard]] Seen seen_of(const Eigen::VectorXd& values) const {
        const Eigen::VectorXd scatter = residuals_.to_scatter * values;
        return {effects_.transpose() * values, scatters_.transpose() * scatter,
                scatter.squaredNorm()};
    }

    DenseResiduals residuals_;
    Eigen::MatrixXd effects_;   ///< (k, n) Projected effects of +1 mGal in each reading.
    Eigen::MatrixXd scatters_;  ///< (k, n) Their parts in the scatter.
    Eigen::MatrixXd whole_, information_, scattered_;  ///< (n, n)
    double dof_ = 0.0;
    Seen seen_;
};

}  // namespace

Eigen::VectorXd normal_vector(std::mt19937_64& generator, Index size) {
    // Box and Muller
    const auto uniform = [&generator] {  // in (0, 1]
        return (static_cast<double>(generator() >> 11) + 1.0) * 0x1p-53;
    };
    Eigen::VectorXd values(size);
    for (double& value : values) {
        const double radius = std::sqrt(-2.0 * std::log(uniform()));
        value = radius * std::cos(2.0 * std::numbers::pi * uniform());
    }
    return values;
}

void DenseResiduals::project(Eigen::VectorXd& whitened) const {
    whitened -= unknown * (unknown.transpose() * whitened);
}

Eigen::VectorXd DenseResiduals::projected(const Eigen::VectorXd& effect_mgal) const {
    Eigen::VectorXd whitened = whitening * effect_mgal;
    const double length = whitened.norm();
    project(whitened);
    if (whitened.norm() < kLeastLeft * length) whitened.setZero();
    return whitened;
}

Direction DenseResiduals::direction(const Eigen::VectorXd& effect_mgal) const {
    Eigen::VectorXd unit = projected(effect_mgal);
    const double length = unit.norm();
    if (length > 0.0) unit /= length;
    Eigen::VectorXd scatter = to_scatter * unit;
    return {std::move(unit), std::move(scatter), length};
}

double DenseResiduals::dof() const {
    return (to_scatter - to_scatter * unknown * unknown.transpose()).squaredNorm();
}

Eigen::VectorXd DenseResiduals::simulated(std::mt19937_64& generator) const {
    Eigen::VectorXd drawn = normal_vector(generator, values.size());
    project(drawn);
    return drawn;
}

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

std::unique_ptr<Residuals> effects_on(DenseResiduals residuals) {
    return std::make_unique<EffectsOn>(std::move(residuals));
}

}  // namespace a351::corrector::adjustment
