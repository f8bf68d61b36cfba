#include "corrector/model/robust_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "corrector/model/paper_correction.hpp"
#include "protocol/linear_algebra/pivoted_qr.hpp"
#include "protocol/signal/median.hpp"

namespace a351::corrector::model {
namespace {

constexpr Eigen::Index kExhaustiveRows = 25;  // 12650 subsets of four rows
constexpr int kDrawnSubsets = 3000;           // with 40 % bad rows, hundreds of them are clean
constexpr std::size_t kBestStarts = 10;
constexpr int kMostSteps = 200;
/// Least scale, mGal.  Reason: below the last digit of any table; rows that are closer agree.
constexpr double kLeastScale = 1e-6;

/// The system y = [1 X] b, and the priors' rows.
struct Problem {
    Eigen::MatrixXd design;  ///< (n, p) Constant, then centred columns.
    Eigen::VectorXd y;       ///< (n) Centred.
    Eigen::MatrixXd prior_design;
    Eigen::VectorXd prior_y;

    /// Solves by weighted least squares; std::nullopt if the weighted rows do not determine b.
    [[nodiscard]] std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& weights) const {
        const Eigen::Index used = (weights.array() > 0.0).count();
        const Eigen::Index p = design.cols();
        Eigen::MatrixXd rows(used + prior_design.rows(), p);
        Eigen::VectorXd right(rows.rows());
        Eigen::Index at = 0;
        for (Eigen::Index i = 0; i < weights.size(); ++i) {
            if (!(weights(i) > 0.0)) continue;
            const double root = std::sqrt(weights(i));
            rows.row(at) = root * design.row(i);
            right(at++) = root * y(i);
        }
        rows.bottomRows(prior_design.rows()) = prior_design;
        right.tail(prior_y.size()) = prior_y;
        if (rows.rows() < p) return std::nullopt;
        const linear_algebra::PivotedQr qr(rows);
        // Temperatures are printed to 0.01 degC: smaller pivots come from equal rows.
        constexpr double kLeastPivot = 1e-9;
        if (!(qr.pivots()(p - 1) > kLeastPivot)) return std::nullopt;
        return qr.solve(right);
    }

    [[nodiscard]] Eigen::VectorXd residuals(const Eigen::VectorXd& b) const {
        return y - design * b;
    }
};

Problem problem_of(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                   const Eigen::Ref<const Eigen::VectorXd>& y, const SlopePriors& priors) {
    const Eigen::Index p = columns.cols() + 1;
    Problem problem;
    problem.design.resize(columns.rows(), p);
    problem.design.col(0).setOnes();
    problem.design.rightCols(p - 1) =
        columns.rowwise() - Eigen::RowVectorXd(columns.colwise().mean());
    problem.y = y.array() - y.mean();
    const Eigen::Index prior_count = (priors.weights.array() > 0.0).count();
    problem.prior_design = Eigen::MatrixXd::Zero(prior_count, p);
    problem.prior_y.resize(prior_count);
    for (Eigen::Index k = 0, row = 0; k < priors.weights.size(); ++k) {
        if (!(priors.weights(k) > 0.0)) continue;
        problem.prior_design(row, k + 1) = priors.weights(k);
        problem.prior_y(row++) = priors.weights(k) * priors.values(k);
    }
    return problem;
}

/// A start of the iteration.
struct Start {
    double trimmed = 0.0;  ///< Sum of the h smallest squared residuals, h rows kept.
    Eigen::VectorXd b;
};

/// Returns weights 1 for the h rows with the smallest residuals, else 0, and the sum of their
/// squares.
std::pair<Eigen::VectorXd, double> best_half(const Eigen::VectorXd& residuals, Eigen::Index h) {
    std::vector<Eigen::Index> order(static_cast<std::size_t>(residuals.size()));
    std::iota(order.begin(), order.end(), Eigen::Index(0));
    std::ranges::sort(order, {},
                      [&](Eigen::Index i) { return std::pair(std::abs(residuals(i)), i); });
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(residuals.size());
    double trimmed = 0.0;
    for (Eigen::Index k = 0; k < h; ++k) {
        const Eigen::Index i = order[static_cast<std::size_t>(k)];
        weights(i) = 1.0;
        trimmed += residuals(i) * residuals(i);
    }
    return {weights, trimmed};
}

/// Calls `visit` with the 0/1 weights of each subset of p rows.
template <class Visit>
void for_each_subset(Eigen::Index n, Eigen::Index p, const Visit& visit) {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(n);
    if (n <= kExhaustiveRows) {
        std::vector<bool> chosen(static_cast<std::size_t>(n), false);
        std::fill(chosen.begin(), chosen.begin() + p, true);
        do {
            for (Eigen::Index i = 0; i < n; ++i)
                weights(i) = chosen[static_cast<std::size_t>(i)] ? 1.0 : 0.0;
            visit(weights);
        } while (std::prev_permutation(chosen.begin(), chosen.end()));
        return;
    }
    std::mt19937_64 generator(1);  // fixed seed: the fit does not depend on the survey's
    for (int draw = 0; draw < kDrawnSubsets; ++draw) {
        weights.setZero();
        for (Eigen::Index chosen = 0; chosen < p;) {
            double& weight =
                weights(static_cast<Eigen::Index>(generator() % static_cast<std::uint64_t>(n)));
            if (weight > 0.0) continue;
            weight = 1.0;
            ++chosen;
        }
        visit(weights);
    }
}

std::optional<Eigen::VectorXd> least_trimmed_squares(const Problem& problem) {
    const Eigen::Index n = problem.y.size();
    const Eigen::Index p = problem.design.cols();
    const Eigen::Index h = (n + p + 1) / 2;
    const auto is_better = [](const Start& a, const Start& b) { return a.trimmed < b.trimmed; };
    std::vector<Start> best;  // a heap with the worst in front
    for_each_subset(n, p, [&](const Eigen::VectorXd& weights) {
        auto b = problem.solve(weights);
        if (!b) return;
        Start start{0.0, std::move(*b)};
        Eigen::ArrayXd squares = problem.residuals(start.b).array().square();
        std::nth_element(squares.begin(), squares.begin() + (h - 1), squares.end());
        start.trimmed = squares.head(h).sum();
        if (best.size() == kBestStarts && !is_better(start, best.front())) return;
        if (best.size() == kBestStarts) {
            std::pop_heap(best.begin(), best.end(), is_better);
            best.pop_back();
        }
        best.push_back(std::move(start));
        std::push_heap(best.begin(), best.end(), is_better);
    });
    if (best.empty()) return std::nullopt;
    for (Start& start : best) {
        for (int step = 0; step < kMostSteps; ++step) {
            const auto b = problem.solve(best_half(problem.residuals(start.b), h).first);
            if (!b) break;
            Start next{best_half(problem.residuals(*b), h).second, *b};
            if (!is_better(next, start)) break;
            start = std::move(next);
        }
    }
    return std::min_element(best.begin(), best.end(), is_better)->b;
}

double median_size(const Eigen::VectorXd& residuals) {
    std::vector<double> sizes(residuals.begin(), residuals.end());
    for (double& size : sizes) size = std::abs(size);
    std::ranges::sort(sizes);
    const std::size_t n = sizes.size();
    return n % 2 == 1 ? sizes[n / 2] : 0.5 * (sizes[n / 2 - 1] + sizes[n / 2]);
}

/// Returns w = (1 - u^2)^2 for |u| < 1, else 0, with u = r / (c scale).
Eigen::VectorXd bisquare_weights(const Eigen::VectorXd& residuals, double scale) {
    const Eigen::ArrayXd u = residuals.array() / (kBisquareTuning * scale);
    return (u.abs() < 1.0).select((1.0 - u.square()).square(), 0.0);
}

/// Returns s of s^2 = K^2 sum psi^2 / (n - p) / mean(psi')^2 (Huber 1981, 7.6), where psi = w r and
/// psi' = (1 - u^2)(1 - 5 u^2) for |u| < 1, else 0.  K = 1 + p / n var(psi') / mean(psi')^2 corrects
/// for few rows.
double covariance_scale(const RobustFit& robust) {
    const Eigen::ArrayXd r = robust.fit.residuals.array();
    const Eigen::ArrayXd u2 = (r / (kBisquareTuning * robust.start_scale)).square();
    const Eigen::ArrayXd slopes = (u2 < 1.0).select((1.0 - u2) * (1.0 - 5.0 * u2), 0.0);
    const double slope = slopes.mean(), variance = (slopes - slope).square().mean();
    const auto n = static_cast<double>(robust.fit.row_count()),
               p = static_cast<double>(robust.fit.parameter_count());
    const double k = 1.0 + p / n * variance / (slope * slope);
    return k * std::sqrt((robust.weights.array() * r).square().sum() / (n - p)) / slope;
}

/// Returns the root mean square error (mGal) of predicting each row from the rows that `is_other`
/// keeps for it.
template <class IsOther>
std::optional<double> left_out_mgal(const LinearModel& model,
                                    const std::vector<reading::SurveyRow>& rows,
                                    const TimeOrigin& origin, const Priors& priors,
                                    const IsOther& is_other) {
    const Eigen::MatrixXd columns = model_columns(model, rows, origin);
    const std::vector<double> differences = differences_mgal(rows);
    std::vector<std::optional<double>> errors(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (errors[i]) continue;
        std::vector<reading::SurveyRow> others;
        std::vector<std::size_t> left_out;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            if (is_other(k, i))
                others.push_back(rows[k]);
            else
                left_out.push_back(k);
        }
        const auto robust = fit_robust_model(model, others, origin, priors);
        if (!robust) return std::nullopt;
        for (const std::size_t k : left_out) {
            const auto x = columns.row(static_cast<Eigen::Index>(k)).transpose();
            errors[k] = differences[k] - robust->fit.at(x);
        }
    }
    double squares = 0.0;
    for (const auto& error : errors) squares += *error * *error;
    return std::sqrt(squares / static_cast<double>(rows.size()));
}

}  // namespace

std::optional<RobustFit> fit_robust(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                    const Eigen::Ref<const Eigen::VectorXd>& y,
                                    const SlopePriors& priors) {
    const Eigen::Index n = columns.rows();
    const Eigen::Index p = columns.cols() + 1;
    if (n <= p) return std::nullopt;
    auto all = fit_linear(columns, y, priors);
    if (!all) return std::nullopt;
    const Problem problem = problem_of(columns, y, priors);
    const auto start = least_trimmed_squares(problem);
    if (!start) return std::nullopt;

    RobustFit robust;
    Eigen::VectorXd b = *start;
    // scale = 1.4826 (1 + 5 / (n - p)) median |r|   (Rousseeuw and Leroy 1987)
    robust.start_scale =
        std::max(kLeastScale, signal::kGaussianPerMad * (1.0 + 5.0 / static_cast<double>(n - p)) *
                                  median_size(problem.residuals(b)));
    for (int step = 0; step < kMostSteps; ++step) {
        robust.weights = bisquare_weights(problem.residuals(b), robust.start_scale);
        const auto next = problem.solve(robust.weights);
        if (!next) return std::nullopt;
        const double change = (problem.design * (*next - b)).cwiseAbs().maxCoeff();
        b = *next;
        if (change < kLeastScale * 1e-3) break;
    }
    robust.fit = std::move(*all);
    robust.fit.mean = y.mean() + b(0);
    robust.fit.coefficients.tail(p - 1) = b.tail(p - 1);
    robust.fit.coefficients(0) = robust.fit.mean - b.tail(p - 1).dot(robust.fit.column_means);
    robust.fit.residuals = problem.residuals(b);
    robust.fit.rss = robust.fit.residuals.squaredNorm();
    robust.s = covariance_scale(robust);
    if (!(robust.s > 0.0)) robust.s = robust.start_scale;
    return robust;
}

std::optional<RobustFit> fit_robust_model(const LinearModel& model,
                                          const std::vector<reading::SurveyRow>& rows,
                                          const TimeOrigin& origin, const Priors& priors) {
    if (rows.empty()) return std::nullopt;
    const std::vector<double> differences = differences_mgal(rows);
    const Eigen::Map<const Eigen::VectorXd> y(differences.data(),
                                              static_cast<Eigen::Index>(differences.size()));
    return fit_robust(model_columns(model, rows, origin), y,
                      slope_priors(model, priors, origin.steps.size()));
}

Score score_robust_model(const LinearModel& model, const std::vector<reading::SurveyRow>& rows,
                         const TimeOrigin& origin, const Priors& priors) {
    Score score;
    score.model = "robust";
    score.row_count = rows.size();
    score.parameter_count = model.parameter_count() + origin.steps.size();
    const auto robust = fit_robust_model(model, rows, origin, priors);
    if (!robust) return score;
    score.dof = score.row_count - score.parameter_count;
    score.rms_mgal = std::sqrt(robust->fit.rss / static_cast<double>(rows.size()));
    score.s_mgal = robust->s;
    score.loo_mgal = left_out_mgal(model, rows, origin, priors,
                                   [](std::size_t k, std::size_t i) { return k != i; });
    score.loso_mgal = left_out_mgal(model, rows, origin, priors, [&](std::size_t k, std::size_t i) {
        return rows[k].site != rows[i].site;
    });
    return score;
}

}  // namespace a351::corrector::model
