#include "corrector/model/robust_fit.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::model;

namespace {

/// A line 3 - 2 x with nearly normal errors of 0.5 (quantiles in scrambled order).
struct Line {
    Eigen::VectorXd x, y;

    explicit Line(Eigen::Index n) : x(n), y(n) {
        for (Eigen::Index i = 0; i < n; ++i) {
            x(i) = static_cast<double>(i) / static_cast<double>(n);
            const double share = (static_cast<double>((i * 7) % n) + 0.5) / static_cast<double>(n);
            // Logistic quantiles in place of normal ones, scaled to the same spread.
            y(i) = 3.0 - 2.0 * x(i) + 0.5 / 1.702 * std::log(share / (1.0 - share));
        }
    }
};

}  // namespace

TEST_CASE("without bad rows the robust line is close to least squares", "[survey][robust]") {
    const Line line(GENERATE(20, 40));
    const auto robust = fit_robust(line.x, line.y).value();
    const auto plain = fit_linear(line.x, line.y).value();
    const double error = plain.residual_scale().value() * std::sqrt(plain.cofactor(1, 1));
    CHECK(std::abs(robust.fit.coefficients(1) - plain.coefficients(1)) < 0.5 * error);
    CHECK(robust.s == Approx(plain.residual_scale().value()).epsilon(0.2));
    CHECK(robust.weights.minCoeff() > 0.2);
    CHECK(robust.weights.maxCoeff() <= 1.0);
}

TEST_CASE("a third of the rows with the same large error has no influence at all",
          "[survey][robust]") {
    Line line(GENERATE(21, 42));
    const Eigen::Index third = line.y.size() / 3;
    const auto clean = fit_robust(line.x.tail(2 * third), line.y.tail(2 * third)).value();
    line.y.head(third).array() += 25.0;
    const auto robust = fit_robust(line.x, line.y).value();
    CHECK(robust.weights.head(third).maxCoeff() == 0.0);
    CHECK(robust.fit.coefficients(1) == Approx(clean.fit.coefficients(1)).margin(0.3));
    // Least squares is far off.
    CHECK(std::abs(fit_linear(line.x, line.y)->coefficients(1) + 2.0) > 10.0);
}

TEST_CASE("good rows that agree exactly leave bad rows without influence", "[survey][robust]") {
    auto rows = made_up::day();
    rows[2].acceleration = rows[2].acceleration + MilliGal(60.0);
    rows[8].acceleration = rows[8].acceleration - MilliGal(40.0);
    SurveyOptions options;
    options.model = "robust";
    options.robust_terms = "t-rate-drift";
    const SurveyCorrection result = correct_survey(rows, options);
    CHECK(result.model == "robust");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool is_bad = i == 2 || i == 8;
        CAPTURE(i);
        CHECK((result.rows[i].as<RobustRow>()->weight < 0.5) == is_bad);
        if (!is_bad) {
            CHECK(result.rows[i].residual->value() == Approx(0.0).margin(1e-6));
        }
    }
    CHECK(result.row_sets[0].scores.back().model == "robust");
    CHECK(result.score.loo_mgal.has_value());
    CHECK(result.score.loso_mgal.value() > 1.0);  // the bad rows are predicted as well
    CHECK_FALSE(loo_interval_mgal(result).has_value());
}

TEST_CASE("a prior also constrains the slope of a robust line", "[survey][robust]") {
    const Line line(20);
    const SlopePriors prior{Eigen::VectorXd::Constant(1, -1.0), Eigen::VectorXd::Constant(1, 1e4)};
    CHECK(fit_robust(line.x, line.y, prior)->fit.coefficients(1) == Approx(-1.0).margin(1e-5));
}

TEST_CASE("too few rows for a robust line are refused", "[survey][robust]") {
    CHECK_FALSE(fit_robust(Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(1.0, 2.0)).has_value());
    CHECK_FALSE(fit_robust(Eigen::VectorXd::Ones(9), Eigen::VectorXd::LinSpaced(9, 0, 1)));
}
