/// Computes how often the best possible test could find a step in a survey day.
///
///     step-bound SURVEY.toml SIZE_MGAL FALSE_ALARMS
///
/// Prints the share of steps that are found.  The survey must have no step.  A step of this size and
/// of either sign is in one of its drives, each equally likely.  The test knows the size, the noise
/// and all priors, and compares the mean likelihood of all these steps with that of none.  No test
/// with as many false alarms finds more of them (J. Neyman and E. S. Pearson, Phil. Trans. R. Soc. A
/// 231, 289-337, 1933).

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "corrector/job/survey_readings.hpp"
#include "corrector/model/model.hpp"

namespace {

using namespace a351;
using corrector::residual::Direction;
using corrector::residual::Residuals;

/// Returns the logarithm of the mean likelihood of all steps, divided by that of none.
double log_ratio(const std::vector<Direction>& steps, double size_mgal,
                 const Eigen::VectorXd& values) {
    std::vector<double> logs;
    for (const Direction& step : steps)
        for (const double size : {size_mgal, -size_mgal}) {
            const double length = size * step.length;
            logs.push_back(length * step.unit.dot(values) - 0.5 * length * length);
        }
    const double most = *std::ranges::max_element(logs);
    double sum = 0.0;
    for (const double one : logs) sum += std::exp(one - most);
    return most + std::log(sum);
}

/// Returns the share of the steps that are found.
double power(const Residuals& residuals, const std::vector<Direction>& steps, double size_mgal,
             double false_alarms) {
    constexpr int kDraws = 20000;
    std::mt19937_64 generator(1);
    std::vector<double> without;
    for (int draw = 0; draw < kDraws; ++draw)
        without.push_back(log_ratio(steps, size_mgal, residuals.simulated(generator)));
    std::ranges::sort(without);
    const double limit = without[static_cast<std::size_t>((1.0 - false_alarms) * kDraws)];
    int found = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
        const Direction& step = steps[static_cast<std::size_t>(draw) % steps.size()];
        const Eigen::VectorXd values =
            residuals.simulated(generator) + size_mgal * step.length * step.unit;
        if (log_ratio(steps, size_mgal, values) > limit) ++found;
    }
    return static_cast<double>(found) / kDraws;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) return 2;
    const auto survey = corrector::job::read_survey_file(argv[1]);
    auto read = corrector::job::read_survey(survey, [](std::size_t, std::size_t) {});
    const auto options = corrector::job::with_sites_of(read, survey.survey);
    const auto choice = corrector::model::choose_rows(read.rows, options.datum, options.use_flags);
    const auto& day = *corrector::model::find_model(corrector::model::kWholeDay);
    const corrector::model::ChosenSurvey chosen{{read.rows, options, &*read.day}, choice};
    const Residuals residuals = day.residuals(chosen, *day.noise(chosen, nullptr)).value();
    std::vector<Direction> steps;
    const auto count = std::ssize(read.rows);
    for (Eigen::Index k = 1; k < count; ++k) {
        Eigen::VectorXd after = Eigen::VectorXd::Ones(count);
        after.head(k).setZero();
        steps.push_back(residuals.direction(after));
    }
    std::printf("%.4f\n", power(residuals, steps, std::atof(argv[2]), std::atof(argv[3])));
}
