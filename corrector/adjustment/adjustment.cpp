#include "corrector/adjustment/adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace a351::corrector::adjustment {
namespace {

using Index = Eigen::Index;

/// Least pivot of a column of length 1 that is determined.  Reason: rounding leaves about 1e-13; the
/// root, 3e-6, is a part of a column that no survey can separate from the others.
constexpr double kLeastPivot = 1e-11;
/// Pivot that rounding can leave.
constexpr double kRounding = 1e-13;
/// Least part of an unknown in a combination that changes no row.
constexpr double kLeastPart = 1e-4;
/// Least pivot without a refinement of Q.  Reason: the relative error of Q is about eps / pivot.
constexpr double kGoodPivot = 1e-5;

}  // namespace

Unknowns gradient_of(const Equations& equations, const Eigen::VectorXd& values) {
    Unknowns gradient{Eigen::VectorXd::Zero(static_cast<Index>(equations.stations)),
                      Eigen::VectorXd::Zero(static_cast<Index>(equations.terms))};
    for (std::size_t i = 0; i < equations.rows.size(); ++i) {
        const Equation& row = equations.rows[i];
        const double weighted = values(static_cast<Index>(i)) / (row.sd * row.sd);
        for (const auto& [unknown, factor] : row.unknowns) {
            if (unknown < equations.stations)
                gradient.stations(static_cast<Index>(unknown)) += factor * weighted;
            else
                gradient.terms(static_cast<Index>(unknown - equations.stations)) +=
                    factor * weighted;
        }
    }
    return gradient;
}

double product(const Equations& equations, std::size_t row, const Unknowns& unknowns) {
    double sum = 0.0;
    for (const auto& [unknown, factor] : equations.rows[row].unknowns)
        sum += factor * (unknown < equations.stations
                             ? unknowns.stations(static_cast<Index>(unknown))
                             : unknowns.terms(static_cast<Index>(unknown - equations.stations)));
    return sum;
}

NormalEquations::NormalEquations(const Equations& equations)
    : of_stations_(Eigen::VectorXd::Zero(static_cast<Index>(equations.stations))),
      of_both_(equations.stations) {
    const auto terms = static_cast<Index>(equations.terms);
    Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(terms, terms);
    prior_weights_ = Eigen::VectorXd::Zero(terms);
    for (const Equation& row : equations.rows) {
        const double weight = 1.0 / (row.sd * row.sd);
        if (row.unknowns.size() == 1 && row.unknowns.front().unknown >= equations.stations)
            prior_weights_(static_cast<Index>(row.unknowns.front().unknown - equations.stations)) +=
                weight;
        for (const auto& [a, factor] : row.unknowns) {
            if (a < equations.stations) {
                of_stations_(static_cast<Index>(a)) += weight * factor * factor;
                auto& line = of_both_[a];
                for (const auto& [b, other] : row.unknowns)
                    if (b >= equations.stations)
                        line.push_back({b - equations.stations, weight * factor * other});
                continue;
            }
            for (const auto& [b, other] : row.unknowns)
                if (b >= equations.stations)
                    reduced(static_cast<Index>(a - equations.stations),
                            static_cast<Index>(b - equations.stations)) += weight * factor * other;
        }
    }
    scale_ = reduced.diagonal().unaryExpr(
        [](double square) { return square > 0.0 ? 1.0 / std::sqrt(square) : 1.0; });
    for (std::size_t station = 0; station < equations.stations; ++station) {
        std::vector<Entry>& line = of_both_[station];
        std::ranges::stable_sort(line, {}, &Entry::unknown);
        std::vector<Entry> sums;
        for (const Entry& entry : line)
            if (!sums.empty() && sums.back().unknown == entry.unknown)
                sums.back().factor += entry.factor;
            else
                sums.push_back(entry);
        line = std::move(sums);
        const double d = of_stations_(static_cast<Index>(station));
        if (!(d > 0.0)) continue;
        // S = C - B' D^-1 B
        for (const auto& [a, of_a] : line)
            for (const auto& [b, of_b] : line)
                reduced(static_cast<Index>(a), static_cast<Index>(b)) -= of_a / d * of_b;
    }
    reduced = scale_.asDiagonal() * reduced * scale_.asDiagonal();
    for (std::size_t station = 0; station < equations.stations; ++station)
        if (!(of_stations_(static_cast<Index>(station)) > 0.0)) undetermined_.push_back(station);
    factor_.emplace(reduced);
    if (terms == 0) return;
    // After a small pivot rounding can leave more than kLeastPivot in a column that depends on others.
    bool is_determined = factor_->is_positive_definite() &&
                         equations.rows.size() >= equations.stations + equations.terms;
    if (is_determined) {
        const Eigen::VectorXd pivots = factor_->lower().diagonal().cwiseAbs2();
        least_pivot_ = pivots.minCoeff();
        for (Index k = 0; k < terms; ++k)
            is_determined = is_determined && pivots(k) > least_pivot_of(k);
    }
    if (!is_determined) find_undetermined(reduced);
}

double NormalEquations::least_pivot_of(Index term) const {
    // A prior determines its term, even if many readings contain nothing about it.
    const double prior = 0.5 * prior_weights_(term) * scale_(term) * scale_(term);
    return prior > kRounding ? std::min(prior, kLeastPivot) : kLeastPivot;
}

void NormalEquations::find_undetermined(const Eigen::MatrixXd& reduced) {
    // Elimination column by column.  A column without a pivot is a combination of those before:
    // U v = -(its part) gives the combination that changes no row.
    const Index n = reduced.rows();
    Eigen::MatrixXd left = reduced;
    std::vector<Index> pivots;
    std::set<std::size_t> open(undetermined_.begin(), undetermined_.end());
    Index weakest = 0;
    double least_pivot = std::numeric_limits<double>::infinity();
    for (Index k = 0; k < n; ++k) {
        if (left(k, k) < least_pivot) {
            least_pivot = left(k, k);
            weakest = k;
        }
        if (left(k, k) > least_pivot_of(k)) {
            for (Index j = k + 1; j < n; ++j) {
                const double part = left(j, k) / left(k, k);
                if (part == 0.0) continue;
                left.row(j).tail(n - k) -= part * left.row(k).tail(n - k);
            }
            pivots.push_back(k);
            continue;
        }
        Eigen::VectorXd combination = Eigen::VectorXd::Zero(n);
        combination(k) = 1.0;
        for (auto pivot = pivots.rbegin(); pivot != pivots.rend(); ++pivot)
            combination(*pivot) =
                -left.row(*pivot).tail(n - *pivot - 1).dot(combination.tail(n - *pivot - 1)) /
                left(*pivot, *pivot);
        for (Index i = 0; i < n; ++i)
            if (std::abs(combination(i)) > kLeastPart)
                open.insert(of_both_.size() + static_cast<std::size_t>(i));
        // The stations follow: g = -D^-1 B t, compared in units of their own columns.
        for (std::size_t station = 0; station < of_both_.size(); ++station) {
            double sum = 0.0;
            for (const auto& [term, factor] : of_both_[station])
                sum += factor * scale_(static_cast<Index>(term)) *
                       combination(static_cast<Index>(term));
            if (std::abs(sum) > kLeastPart * std::sqrt(of_stations_(static_cast<Index>(station))))
                open.insert(station);
        }
    }
    // Rounding hid which column depends on others: the one with the least pivot is named.
    if (open.empty()) open.insert(of_both_.size() + static_cast<std::size_t>(weakest));
    undetermined_.assign(open.begin(), open.end());
}

Unknowns NormalEquations::solve(const Unknowns& gradient) const {
    Unknowns result = gradient;
    for (std::size_t station = 0; station < of_both_.size(); ++station) {
        const auto at = static_cast<Index>(station);
        const double part = gradient.stations(at) / of_stations_(at);
        for (const auto& [term, factor] : of_both_[station])
            result.terms(static_cast<Index>(term)) -= factor * part;
    }
    result.terms = scale_.asDiagonal() * factor_->solve(scale_.asDiagonal() * result.terms);
    for (std::size_t station = 0; station < of_both_.size(); ++station) {
        double left = gradient.stations(static_cast<Index>(station));
        for (const auto& [term, factor] : of_both_[station])
            left -= factor * result.terms(static_cast<Index>(term));
        result.stations(static_cast<Index>(station)) =
            left / of_stations_(static_cast<Index>(station));
    }
    return result;
}

Eigen::MatrixXd NormalEquations::inverse() const {
    const auto stations = static_cast<Index>(of_both_.size());
    const Index terms = scale_.size();
    Eigen::MatrixXd q(stations + terms, stations + terms);
    auto of_terms = q.bottomRightCorner(terms, terms);
    of_terms = scale_.asDiagonal() * factor_->inverse() * scale_.asDiagonal();
    // Q_gt = -D^-1 B Q_tt,  Q_gg = D^-1 + D^-1 B Q_tt B' D^-1
    for (Index g = 0; g < stations; ++g) {
        auto line = q.row(g).tail(terms);
        line.setZero();
        for (const auto& [term, factor] : of_both_[static_cast<std::size_t>(g)])
            line -= factor / of_stations_(g) * of_terms.row(static_cast<Index>(term));
        q.col(g).tail(terms) = line.transpose();
    }
    for (Index g = 0; g < stations; ++g)
        for (Index h = 0; h <= g; ++h) {
            double sum = g == h ? 1.0 / of_stations_(g) : 0.0;
            for (const auto& [term, factor] : of_both_[static_cast<std::size_t>(h)])
                sum -= factor / of_stations_(h) * q(stations + static_cast<Index>(term), g);
            q(g, h) = q(h, g) = sum;
        }
    return q;
}

Adjustment::Adjustment(Equations equations, Cofactor cofactor)
    : equations_(std::move(equations)), normal_(equations_) {
    if (!undetermined().empty()) return;
    const std::vector<Equation>& rows = equations_.rows;
    has_true_ratio_ =
        std::ranges::any_of(rows, [](const Equation& row) { return row.true_ratio != 1.0; });
    Eigen::VectorXd left(std::ssize(rows));
    for (std::size_t i = 0; i < rows.size(); ++i) left(static_cast<Index>(i)) = rows[i].value;
    Unknowns all{Eigen::VectorXd::Zero(static_cast<Index>(equations_.stations)),
                 Eigen::VectorXd::Zero(static_cast<Index>(equations_.terms))};
    constexpr int kRounds = 3;  // the solution, and two refinements
    for (int round = 0; round < kRounds; ++round) {
        const Unknowns more = normal_.solve(gradient_of(equations_, left));
        all.stations += more.stations;
        all.terms += more.terms;
        for (std::size_t i = 0; i < rows.size(); ++i)
            left(static_cast<Index>(i)) = rows[i].value - product(equations_, i, all);
    }
    values_.assign(all.stations.begin(), all.stations.end());
    values_.insert(values_.end(), all.terms.begin(), all.terms.end());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        residuals_.push_back(-left(static_cast<Index>(i)));
        weighted_square_ += std::pow(residuals_[i] / rows[i].sd, 2);
    }
    if (cofactor == Cofactor::computed) compute_cofactor();
}

void Adjustment::compute_cofactor() {
    if (!undetermined().empty() || cofactor_.size() > 0) return;
    cofactor_ = normal_.inverse();
    if (normal_.least_pivot() >= kGoodPivot) return;
    // Q + Q (1 - N Q), with N Q = A' W A Q from the rows
    Eigen::MatrixXd error = Eigen::MatrixXd::Identity(cofactor_.rows(), cofactor_.cols());
    for (const Equation& row : equations_.rows) {
        Eigen::RowVectorXd effect = Eigen::RowVectorXd::Zero(cofactor_.cols());
        for (const auto& [unknown, factor] : row.unknowns)
            effect += factor * cofactor_.row(static_cast<Index>(unknown));
        for (const auto& [unknown, factor] : row.unknowns)
            error.row(static_cast<Index>(unknown)) -= factor / (row.sd * row.sd) * effect;
    }
    const Eigen::MatrixXd refined = cofactor_ + cofactor_ * error;
    cofactor_ = 0.5 * (refined + refined.transpose());
}

std::size_t Adjustment::dof() const {
    const std::size_t unknowns = equations_.stations + equations_.terms;
    return equations_.rows.size() - std::min(equations_.rows.size(), unknowns);
}

std::optional<double> Adjustment::s0() const {
    if (dof() == 0) return std::nullopt;
    return std::sqrt(weighted_square_ / static_cast<double>(dof()));
}

double Adjustment::redundancy(std::size_t row) const {
    const Equation& equation = equations_.rows[row];
    double square = 0.0;
    for (const Entry& a : equation.unknowns)
        for (const Entry& b : equation.unknowns)
            square += a.factor * b.factor * cofactor(a.unknown, b.unknown);
    return 1.0 - square / (equation.sd * equation.sd);
}

std::optional<double> Adjustment::studentised(std::size_t row) const {
    const double r = redundancy(row), sd = equations_.rows[row].sd;
    if (dof() < 2 || r < kLeastRedundancy) return std::nullopt;
    // s_i^2 = (v' W v - v_i^2 / (sd_i^2 r_i)) / (dof - 1)
    const double own = std::pow(residuals_[row] / sd, 2) / r;
    const double square = (weighted_square_ - own) / static_cast<double>(dof() - 1);
    if (!(square > 0.0)) return std::nullopt;
    return residuals_[row] / (sd * std::sqrt(square * r));
}

double Adjustment::cofactor(std::size_t a, std::size_t b) const {
    return cofactor_(static_cast<Index>(a), static_cast<Index>(b));
}

double Adjustment::covariance(const Combination& a, const Combination& b, double noise) const {
    const auto stated = [this](const Combination& left, const Combination& right) {
        double sum = 0.0;
        for (const Entry& l : left)
            for (const Entry& r : right)
                sum += l.factor * r.factor * cofactor(l.unknown, r.unknown);
        return sum;
    };
    if (noise == 1.0 && !has_true_ratio_) return stated(a, b);
    // Error of x: Q A' W e.  A row of another standard deviation than stated counts with its own.
    double others = 0.0, true_others = 0.0;
    for (const Equation& row : equations_.rows) {
        if (row.is_reading) continue;
        const double part = stated(a, row.unknowns) * stated(b, row.unknowns) / (row.sd * row.sd);
        others += part;
        true_others += row.true_ratio * row.true_ratio * part;
    }
    return noise * noise * (stated(a, b) - others) + true_others;
}

}  // namespace a351::corrector::adjustment
