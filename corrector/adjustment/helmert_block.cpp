#include "corrector/adjustment/helmert_block.hpp"

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::adjustment {

std::optional<HelmertBlock> helmert_block(const AdjustedSurvey& adjusted) {
    using Index = Eigen::Index;
    const Equations& equations = adjusted.adjustment.equations();
    const auto stations = static_cast<Index>(equations.stations);
    const auto terms = static_cast<Index>(equations.terms);
    const Index rest = stations + 1;  // and the misclosure
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(terms + rest, terms + rest);
    Eigen::VectorXd line(terms + rest);
    for (std::size_t i = 0; i < equations.rows.size(); ++i) {
        const Equation& row = equations.rows[i];
        if (!row.is_reading && row.unknowns.front().unknown < equations.stations) continue;
        line.setZero();
        for (const auto& [unknown, factor] : row.unknowns)
            line(unknown < equations.stations ? terms + static_cast<Index>(unknown)
                                              : static_cast<Index>(unknown - equations.stations)) +=
                factor / row.sd;
        line(terms + stations) = -adjusted.adjustment.residual(i) / row.sd;
        products += line * line.transpose();
    }
    HelmertBlock block{Eigen::VectorXd(stations), products.bottomRightCorner(rest, rest)};
    for (Index k = 0; k < stations; ++k)
        block.gravities_mgal(k) = adjusted.gravity(static_cast<std::size_t>(k)).value();
    // Columns of length 1, because the units of the terms differ by orders.
    const Eigen::VectorXd scale = products.diagonal().head(terms).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd of_both = scale.asDiagonal() * products.topRightCorner(terms, rest);
    const linear_algebra::Cholesky factor(
        scale.asDiagonal() * products.topLeftCorner(terms, terms) * scale.asDiagonal());
    if (!factor.is_positive_definite()) return std::nullopt;
    block.products -= of_both.transpose() * factor.solve(of_both);
    return block;
}

}  // namespace a351::corrector::adjustment
