/// Computes how often the best possible test could find a misfit in a survey day.
///
///     misfit-bound SURVEY.toml FALSE_ALARMS step SIZE_MGAL
///     misfit-bound SURVEY.toml FALSE_ALARMS gross SHARE FACTOR
///
/// Prints the share of misfits that are found.  The survey must have none.
/// - step: a step of this size and of either sign is in one of the drives, each equally likely.
/// - gross: each set-up has with this probability a placement that is larger by this factor.
///
/// The test knows size, share and factor, the noise and all priors, and compares the likelihood of
/// all these misfits together with that of none.  No test with as many false alarms finds more of them
/// (J. Neyman and E. S. Pearson, Phil. Trans. R. Soc. A 231, 289-337, 1933).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "corrector/job/survey_readings.hpp"
#include "corrector/model/adjusted_day.hpp"
#include "corrector/model/calibration_use.hpp"
#include "corrector/whole_day/set_up_residuals.hpp"

namespace {

using namespace a351;
using Residuals = corrector::adjustment::DenseResiduals;
using Index = Eigen::Index;

/// A kind of misfit.
struct Misfit {
    Index draws = 0;  ///< Number of simulated days.
    /// Adds the misfit to a day (k); the argument is the number of the day.
    std::function<Eigen::VectorXd(Index)> effect;
    /// Returns ln of its likelihood divided by that of none, for days (k, days).
    std::function<Eigen::VectorXd(const Eigen::MatrixXd&)> log_ratios;
};

/// Returns ln(mean(exp(a))) of the columns, up to a constant.
Eigen::VectorXd log_means(const Eigen::MatrixXd& a) {
    const Eigen::RowVectorXd most = a.colwise().maxCoeff();
    return (most.array() + (a.rowwise() - most).array().exp().colwise().sum().log()).transpose();
}

Misfit a_step(const Residuals& residuals, double size_mgal) {
    const Index set_ups = residuals.whitening.cols();
    Eigen::MatrixXd effects(residuals.values.size(), 2 * (set_ups - 1));
    for (Index k = 1; k < set_ups; ++k) {
        Eigen::VectorXd after = Eigen::VectorXd::Ones(set_ups);
        after.head(k).setZero();
        effects.col(k - 1) = size_mgal * residuals.projected(after);
        effects.col(set_ups + k - 2) = -effects.col(k - 1);
    }
    const Eigen::VectorXd squares = effects.colwise().squaredNorm();
    return {20000, [effects](Index day) { return effects.col(day % (effects.cols() / 2)).eval(); },
            [effects, squares](const Eigen::MatrixXd& days) {
                return log_means((effects.transpose() * days).colwise() - 0.5 * squares);
            }};
}

/// Sums the likelihoods of all subsets of set-ups that may be gross.
struct GrossSubsets {
    double share;         ///< Probability that a set-up is gross.
    double variance;      ///< Added to the variance of a gross one, mGal^2.
    Eigen::ArrayXd most;  ///< (days) ln of a limit of the likelihood ratios.
    Eigen::ArrayXd sum;   ///< (days) Sum of the ratios, divided by this limit.

    /// Adds all subsets of the set-ups that remain.
    /// @param between  (m, m) inner products of their whitened effects.
    /// @param effects  (m, days) inner products of these with the residuals.
    /// @param log      (days) ln(prior x likelihood ratio) of the set-ups before.
    /// @param left     number of set-ups that may still be gross.
    void add(const Eigen::MatrixXd& between, const Eigen::MatrixXd& effects,
             const Eigen::ArrayXd& log, int left) {
        const Index rest = between.rows() - 1;
        if (rest < 0 || left == 0) {
            const double others = static_cast<double>(rest + 1) * std::log1p(-share);
            sum += (log + others - most).exp();
            return;
        }
        add(between.bottomRightCorner(rest, rest), effects.bottomRows(rest),
            log + std::log1p(-share), left);
        const double factor = 1.0 + variance * between(0, 0);
        const Eigen::VectorXd taken = variance / factor * between.col(0).tail(rest);
        add(between.bottomRightCorner(rest, rest) - taken * between.row(0).tail(rest),
            effects.bottomRows(rest) - taken * effects.row(0),
            log + std::log(share) - 0.5 * std::log(factor) +
                0.5 * variance / factor * effects.row(0).transpose().array().square(),
            left - 1);
    }
};

/// @param placement_mgal  placement that is part of the residuals' covariance.
Misfit gross_placement(const Residuals& residuals, double placement_mgal, double share,
                       double factor) {
    // More than seven of 19 set-ups are gross with a probability of 2 %.  On one day all subsets
    // gave the same share to 0.001.
    constexpr int kMostGross = 7;
    const Index set_ups = residuals.whitening.cols();
    Eigen::MatrixXd effects(residuals.values.size(), set_ups);
    for (Index k = 0; k < set_ups; ++k)
        effects.col(k) = residuals.projected(Eigen::VectorXd::Unit(set_ups, k));
    const double variance = (factor * factor - 1.0) * placement_mgal * placement_mgal;
    return {2000,
            [=, generator = std::mt19937_64(2)](Index) mutable {
                std::normal_distribution<double> normal(0.0, std::sqrt(variance));
                std::bernoulli_distribution is_gross(share);
                Eigen::VectorXd more = Eigen::VectorXd::Zero(set_ups);
                for (double& one : more)
                    if (is_gross(generator)) one = normal(generator);
                return (effects * more).eval();
            },
            [=](const Eigen::MatrixXd& days) -> Eigen::VectorXd {
                GrossSubsets subsets{share, variance,
                                     0.5 * days.colwise().squaredNorm().transpose().array(),
                                     Eigen::ArrayXd::Zero(days.cols())};
                subsets.add(effects.transpose() * effects, effects.transpose() * days,
                            Eigen::ArrayXd::Zero(days.cols()), kMostGross);
                return subsets.most + subsets.sum.log();
            }};
}

/// Returns the share of the misfits that are found.
double power(const Residuals& residuals, const Misfit& misfit, double false_alarms) {
    std::mt19937_64 generator(1);
    Eigen::MatrixXd without(residuals.values.size(), misfit.draws), with = without;
    for (auto day : without.colwise()) day = residuals.simulated(generator);
    for (Index k = 0; k < misfit.draws; ++k)
        with.col(k) = residuals.simulated(generator) + misfit.effect(k);
    Eigen::VectorXd ordinary = misfit.log_ratios(without);
    std::ranges::sort(ordinary);
    const auto draws = static_cast<double>(misfit.draws);
    const double limit = ordinary(static_cast<Index>((1.0 - false_alarms) * draws));
    return static_cast<double>((misfit.log_ratios(with).array() > limit).count()) / draws;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) return 2;
    const bool is_step = std::string_view(argv[3]) == "step";
    if (!is_step && (argc < 6 || std::string_view(argv[3]) != "gross")) return 2;
    const auto survey = corrector::job::read_survey_file(argv[1]);
    auto read = corrector::job::read_survey(survey, [](std::size_t, std::size_t) {});
    const auto options = corrector::job::with_sites_of(read, survey.survey);
    const auto choice = corrector::model::choose_rows(read.rows, options.datum, options.use_flags);
    const auto of_day = corrector::model::day_survey({read.rows, options, &*read.day}, choice,
                                                     corrector::model::day_priors_of(options));
    const auto fit = corrector::whole_day::adjust_day(of_day).value().fit();
    const Residuals residuals = corrector::whole_day::set_up_residuals(
        of_day, fit, corrector::whole_day::NoiseCovariance(of_day.record->bins));
    const double placement_mgal = fit.expected_noise.placement_mgal;
    const double size = std::atof(argv[4]);
    const Misfit misfit =
        is_step ? a_step(residuals, size)
                : gross_placement(residuals, placement_mgal, size, std::atof(argv[5]));
    std::printf("%.4f\n", power(residuals, misfit, std::atof(argv[2])));
}
