#include "corrector/adjustment/residuals.hpp"

#include <utility>

namespace a351::corrector::adjustment {
namespace {

using Index = Eigen::Index;

double sum_over(const Eigen::MatrixXd& matrix, const Effect& a, const Effect& b) {
    double sum = 0.0;
    for (const std::size_t i : a)
        for (const std::size_t k : b) sum += matrix(static_cast<Index>(i), static_cast<Index>(k));
    return sum;
}

class DenseResiduals final : public Residuals {
public:
    explicit DenseResiduals(residual::Residuals residuals)
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

    residual::Residuals residuals_;
    Eigen::MatrixXd effects_;   ///< (k, n) Projected effects of +1 mGal in each reading.
    Eigen::MatrixXd scatters_;  ///< (k, n) Their parts in the scatter.
    Eigen::MatrixXd whole_, information_, scattered_;  ///< (n, n)
    double dof_ = 0.0;
    Seen seen_;
};

}  // namespace

std::unique_ptr<Residuals> dense_residuals(residual::Residuals residuals) {
    return std::make_unique<DenseResiduals>(std::move(residuals));
}

}  // namespace a351::corrector::adjustment
