#include "corrector/adjustment/trials.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "corrector/adjustment/dense_residuals.hpp"

namespace a351::corrector::adjustment {
namespace {

using Index = Eigen::Index;

/// A survey at one noise, linearised and factored.
struct Base {
    SurveyEquations survey;
    Adjustment solution;
    Eigen::VectorXd residuals;  ///< (rows) y - A x, in standard deviations.

    explicit Base(SurveyEquations of)
        : survey(std::move(of)), solution(survey.equations(), Cofactor::left_out) {
        if (!solution.undetermined().empty()) return;
        residuals.resize(std::ssize(rows()));
        for (std::size_t i = 0; i < rows().size(); ++i)
            residuals(static_cast<Index>(i)) = -solution.residual(i) / rows()[i].sd;
    }

    [[nodiscard]] const std::vector<Equation>& rows() const { return solution.equations().rows; }

    /// Returns a vector of the rows, in standard deviations, minus the part that the unknowns
    /// explain.
    [[nodiscard]] Eigen::VectorXd projected(Eigen::VectorXd whitened) const {
        Eigen::VectorXd values = whitened;
        for (std::size_t i = 0; i < rows().size(); ++i)
            values(static_cast<Index>(i)) *= rows()[i].sd;
        const Unknowns x = solution.normal().solve(gradient_of(solution.equations(), values));
        for (std::size_t i = 0; i < rows().size(); ++i)
            whitened(static_cast<Index>(i)) -= product(solution.equations(), i, x) / rows()[i].sd;
        return whitened;
    }

    /// Returns the effect of +1 mGal in some readings on the rows, in standard deviations.
    [[nodiscard]] Eigen::VectorXd effect(const Effect& readings) const {
        Eigen::VectorXd whitened = Eigen::VectorXd::Zero(std::ssize(rows()));
        for (const std::size_t reading : readings)
            if (const auto row = survey.equation_of(reading))
                whitened(static_cast<Index>(*row)) = 1.0 / rows()[*row].sd;
        return whitened;
    }

    /// Returns A' W d of an effect d.
    [[nodiscard]] Combination gradient(const Effect& readings) const {
        std::map<std::size_t, double> sums;
        for (const std::size_t reading : readings) {
            const auto row = survey.equation_of(reading);
            if (!row) continue;
            const Equation& equation = rows()[*row];
            for (const auto& [unknown, factor] : equation.unknowns)
                sums[unknown] += factor / (equation.sd * equation.sd);
        }
        Combination gradient;
        for (const auto& [unknown, factor] : sums) gradient.push_back({unknown, factor});
        return gradient;
    }
};

/// Returns the offsets by which an alternative is put right.
std::vector<Effect> offsets_of(const Alternative& alternative, bool is_exact) {
    if (alternative.kind == AlternativeKind::swap) return {};
    // Without its reference a row of a model with exact references is not in the equations.
    const bool is_excluded = alternative.kind == AlternativeKind::set_up ||
                             alternative.kind == AlternativeKind::stay ||
                             (alternative.kind == AlternativeKind::station && is_exact);
    if (!is_excluded) return {alternative.readings};
    std::vector<Effect> offsets;
    for (const std::size_t reading : alternative.readings) offsets.push_back({reading});
    return offsets;
}

/// Changes in the residuals of a base if alternatives are put right.
struct Correction {
    Eigen::MatrixXd basis;      ///< (rows, k) Orthonormal directions of the offsets.
    Eigen::VectorXd residuals;  ///< (rows) Without them, and with the names exchanged.

    Correction(const Base& base, const std::vector<Alternative>& known)
        : basis(base.residuals.size(), 0), residuals(base.residuals) {
        for (const Alternative& one : known) {
            for (const Effect& offset : offsets_of(one, base.survey.design().is_exact))
                add(base.projected(base.effect(offset)), base.effect(offset).norm());
            if (one.kind == AlternativeKind::swap)
                residuals += one.size_mgal *
                             base.projected(base.effect(one.others) - base.effect(one.readings));
        }
        residuals -= basis * (basis.transpose() * residuals);
    }

    [[nodiscard]] double dof(const Base& base) const {
        return static_cast<double>(base.solution.dof()) - static_cast<double>(basis.cols());
    }

private:
    void add(Eigen::VectorXd direction, double whole) {
        constexpr double kNothing = 1e-6;  // relative length that is left by rounding
        direction -= basis * (basis.transpose() * direction);
        const double length = direction.norm();
        if (length < kNothing * whole) return;
        basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
        basis.rightCols(1) = direction / length;
    }
};

class WhiteResiduals final : public Residuals {
public:
    /// @param noise  standard deviation of the readings, divided by that of the base.
    WhiteResiduals(std::shared_ptr<const Base> base, Correction correction, double noise)
        : base_(std::move(base)), correction_(std::move(correction)), noise_(noise) {
        seen_ = seen_of(correction_.residuals / noise_);
    }

    [[nodiscard]] const Seen& seen() const override { return seen_; }
    [[nodiscard]] double dof() const override { return correction_.dof(*base_); }
    [[nodiscard]] bool is_plain() const override { return true; }

    [[nodiscard]] Seen simulated(std::mt19937_64& generator) const override {
        Eigen::VectorXd drawn =
            base_->projected(normal_vector(generator, correction_.residuals.size()));
        drawn -= correction_.basis * (correction_.basis.transpose() * drawn);
        return seen_of(drawn);
    }

    [[nodiscard]] double information(const Effect& a, const Effect& b) const override {
        const Combination of_a = base_->gradient(a), of_b = base_->gradient(b);
        double sum = 0.0;
        for (const std::size_t reading : a)
            if (std::ranges::find(b, reading) != b.end()) sum += weight_of(reading);
        sum -= base_->solution.covariance(of_a, of_b);
        if (correction_.basis.cols() > 0) sum -= part_of(a).dot(part_of(b));
        return sum / (noise_ * noise_);
    }

    [[nodiscard]] double whole(const Effect& d) const override {
        double sum = 0.0;
        for (const std::size_t reading : d) sum += weight_of(reading);
        return sum / (noise_ * noise_);
    }

    [[nodiscard]] double scattered(const Effect& a, const Effect& b) const override {
        return information(a, b);
    }

private:
    [[nodiscard]] double weight_of(std::size_t reading) const {
        const auto row = base_->survey.equation_of(reading);
        return row ? 1.0 / (base_->rows()[*row].sd * base_->rows()[*row].sd) : 0.0;
    }

    /// Returns the part of an effect in the directions of the correction.
    [[nodiscard]] Eigen::VectorXd part_of(const Effect& readings) const {
        Eigen::VectorXd part = Eigen::VectorXd::Zero(correction_.basis.cols());
        for (const std::size_t reading : readings)
            if (const auto row = base_->survey.equation_of(reading))
                part += correction_.basis.row(static_cast<Index>(*row)).transpose() /
                        base_->rows()[*row].sd;
        return part;
    }

    [[nodiscard]] Seen seen_of(const Eigen::VectorXd& residuals) const {
        Seen seen;
        seen.weighted = Eigen::VectorXd::Zero(std::ssize(base_->survey.rows()));
        for (const ReadingRow& reading : base_->survey.readings()) {
            const std::size_t row = *base_->survey.equation_of(reading.row);
            seen.weighted(static_cast<Index>(reading.row)) =
                residuals(static_cast<Index>(row)) / (base_->rows()[row].sd * noise_);
        }
        seen.square = residuals.squaredNorm();
        return seen;
    }

    std::shared_ptr<const Base> base_;
    Correction correction_;
    double noise_ = 1.0;
    Seen seen_;
};

class WhiteTrials final : public Trials {
public:
    explicit WhiteTrials(AdjustedSurvey survey)
        : base_(std::make_shared<Base>(std::move(survey.survey))) {}

    [[nodiscard]] std::shared_ptr<const Residuals> residuals(
        const std::vector<Alternative>& known, const std::vector<Alternative>& quiet) override {
        // The noise of a base scales the readings alone, the rest of the noise priors and references
        // too; so a base is used for a noise near its own.
        constexpr double kNear = 1.05;
        constexpr int kRounds = 4;
        std::optional<double> noise = noise_of(quiet);
        for (int round = 0; noise && round < kRounds; ++round) {
            if (*noise<kNear&& * noise> 1.0 / kNear) break;
            move_base(quiet, *noise);
            noise = noise_of(quiet);
        }
        if (!noise) return nullptr;
        base_->solution.compute_cofactor();
        return std::make_shared<WhiteResiduals>(base_, Correction(*base_, known), *noise);
    }

private:
    [[nodiscard]] std::optional<double> noise_of(const std::vector<Alternative>& quiet) const {
        if (!base_->solution.undetermined().empty()) return std::nullopt;
        const Correction correction(*base_, quiet);
        const double dof = correction.dof(*base_), square = correction.residuals.squaredNorm();
        if (!(dof > 0.0) || !(square > 0.0)) return std::nullopt;
        return std::sqrt(square / dof);
    }

    /// Makes a base at another noise, linearised at the gravities without the alternatives.
    void move_base(const std::vector<Alternative>& quiet, double noise) {
        SurveyEquations survey = base_->survey;
        survey.set_noise(survey.noise() * noise);
        Equations equations = survey.equations();
        for (const Alternative& one : quiet) {
            for (const Effect& offset : offsets_of(one, survey.design().is_exact)) {
                for (const std::size_t reading : offset)
                    if (const auto row = survey.equation_of(reading))
                        equations.rows[*row].unknowns.push_back(
                            {equations.unknown_of_term(equations.terms), 1.0});
                ++equations.terms;
            }
            if (one.kind != AlternativeKind::swap) continue;
            for (const bool is_other : {false, true})
                for (const std::size_t reading : is_other ? one.others : one.readings)
                    if (const auto row = survey.equation_of(reading))
                        equations.rows[*row].value += is_other ? one.size_mgal : -one.size_mgal;
        }
        const Adjustment right(std::move(equations), Cofactor::left_out);
        if (right.undetermined().empty()) {
            std::map<std::string, MilliGal> gravities;
            for (std::size_t k = 0; k < survey.stations().size(); ++k)
                gravities[survey.stations()[k].site] = survey.origin() + MilliGal(right.value(k));
            survey.linearise(gravities);
        }
        base_ = std::make_shared<Base>(std::move(survey));
    }

    std::shared_ptr<Base> base_;
};

}  // namespace

std::unique_ptr<Trials> white_trials(AdjustedSurvey survey) {
    return std::make_unique<WhiteTrials>(std::move(survey));
}

}  // namespace a351::corrector::adjustment
