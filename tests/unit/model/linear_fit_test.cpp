#include "corrector/model/linear_fit.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::model;

namespace {

const Eigen::VectorXd kX = (Eigen::VectorXd(6) << 0.1, 0.5, 0.7, 1.4, 1.9, 2.2).finished();
const Eigen::VectorXd kY = (Eigen::VectorXd(6) << 1.0, 1.9, 1.7, 4.2, 4.8, 5.9).finished();

}  // namespace

TEST_CASE("exact data give their coefficients and residuals of zero", "[survey][linear_fit]") {
    Eigen::MatrixXd columns(6, 2);
    columns << kX, kX.array().square().matrix();
    const Eigen::VectorXd y = (3.0 - 2.0 * columns.col(0).array() + 0.5 * columns.col(1).array());
    const auto fit = fit_linear(columns, y).value();
    CHECK(fit.coefficients(0) == Approx(3.0));
    CHECK(fit.coefficients(1) == Approx(-2.0));
    CHECK(fit.coefficients(2) == Approx(0.5));
    CHECK(fit.residuals.cwiseAbs().maxCoeff() < 1e-12);
    CHECK(fit.at(Eigen::Vector2d(2.0, 4.0)) == Approx(1.0));
}

TEST_CASE("a line has the textbook coefficients and standard errors", "[survey][linear_fit]") {
    // Sums by hand: b = Sxy/Sxx, var(b) = s^2/Sxx, var(a) = s^2 (1/n + mean^2/Sxx).
    const double mean = kX.mean();
    const double sxx = (kX.array() - mean).square().sum();
    const double sxy = ((kX.array() - mean) * (kY.array() - kY.mean())).sum();
    const auto fit = fit_linear(kX, kY).value();
    CHECK(fit.coefficients(1) == Approx(sxy / sxx));
    CHECK(fit.coefficients(0) == Approx(kY.mean() - sxy / sxx * mean));
    CHECK(fit.cofactor(1, 1) == Approx(1.0 / sxx));
    CHECK(fit.cofactor(0, 0) == Approx(1.0 / 6.0 + mean * mean / sxx));
    CHECK(fit.cofactor(0, 1) == Approx(-mean / sxx));
    CHECK(fit.residual_scale().value() == Approx(std::sqrt(fit.rss / 4.0)));
    CHECK(fit.r_squared == Approx(sxy * sxy / sxx / (kY.array() - kY.mean()).square().sum()));
}

TEST_CASE("leverages add up to the number of coefficients", "[survey][linear_fit]") {
    Eigen::MatrixXd columns(6, 2);
    columns << kX, kX.array().sin().matrix();
    CHECK(fit_linear(columns, kY).value().leverages.sum() == Approx(3.0));
}

TEST_CASE("a residual divided by 1 - leverage is the error of predicting the row without it",
          "[survey][linear_fit]") {
    const auto fit = fit_linear(kX, kY).value();
    for (Eigen::Index out = 0; out < 6; ++out) {
        Eigen::VectorXd x(5), y(5);
        for (Eigen::Index i = 0, k = 0; i < 6; ++i) {
            if (i == out) continue;
            x(k) = kX(i);
            y(k++) = kY(i);
        }
        const double predicted = fit_linear(x, y).value().at(kX.segment(out, 1));
        CHECK(fit.residuals(out) / (1.0 - fit.leverages(out)) == Approx(kY(out) - predicted));
    }
}

TEST_CASE("a large constant in y costs no accuracy", "[survey][linear_fit]") {
    const auto small = fit_linear(kX, kY).value();
    const auto large = fit_linear(kX, (kY.array() + 980000.0).matrix()).value();
    CHECK(large.coefficients(1) == Approx(small.coefficients(1)).epsilon(1e-9));
    CHECK(large.rss == Approx(small.rss).epsilon(1e-8));
}

TEST_CASE("a coefficient that the rows do not determine is not fitted", "[survey][linear_fit]") {
    Eigen::MatrixXd twice(6, 2);
    twice << kX, 3.0 * kX;
    CHECK_FALSE(fit_linear(twice, kY).has_value());
    CHECK_FALSE(fit_linear(Eigen::VectorXd::Constant(6, 42.61), kY).has_value());
    CHECK_FALSE(fit_linear(kX.head(1), kY.head(1)).has_value());
    CHECK(fit_linear(kX.head(2), kY.head(2)).has_value());
    CHECK_FALSE(fit_linear(kX.head(2), kY.head(2)).value().residual_scale().has_value());
}

TEST_CASE("a prior on a slope acts as one more row of the system", "[survey][linear_fit]") {
    // By hand for a line: b = (Sxy + w^2 m) / (Sxx + w^2); the mean stays free.
    const double sxx = (kX.array() - kX.mean()).square().sum();
    const double sxy = ((kX.array() - kX.mean()) * (kY.array() - kY.mean())).sum();
    const double w = 0.7;
    const SlopePriors prior{Eigen::VectorXd::Constant(1, 1.0), Eigen::VectorXd::Constant(1, w)};
    const auto fit = fit_linear(kX, kY, prior).value();
    const double slope = (sxy + w * w) / (sxx + w * w);
    CHECK(fit.coefficients(1) == Approx(slope));
    CHECK(fit.coefficients(0) == Approx(kY.mean() - slope * kX.mean()));
    CHECK(fit.cofactor(1, 1) == Approx(1.0 / (sxx + w * w)));
    CHECK(fit.prior_rss == Approx(w * w * (slope - 1.0) * (slope - 1.0)));
    CHECK(fit.dof() == 5);
    CHECK(fit.residual_scale().value() == Approx(std::sqrt((fit.rss + fit.prior_rss) / 5.0)));
    const auto without_first = fit_linear(kX.tail(5), kY.tail(5), prior).value();
    CHECK(fit.residuals(0) / (1.0 - fit.leverages(0)) ==
          Approx(kY(0) - without_first.at(kX.head(1))));
}

TEST_CASE("a prior determines a coefficient that the rows do not determine",
          "[survey][linear_fit]") {
    const Eigen::VectorXd constant = Eigen::VectorXd::Constant(6, 42.5);
    const SlopePriors prior{Eigen::VectorXd::Constant(1, -30.0), Eigen::VectorXd::Constant(1, 0.4)};
    CHECK_FALSE(fit_linear(constant, kY).has_value());
    const auto fit = fit_linear(constant, kY, prior).value();
    CHECK(fit.coefficients(1) == Approx(-30.0));
    CHECK(fit.at(constant.head(1)) == Approx(kY.mean()));
}

TEST_CASE("errors have the scatter of the rows and the stated standard deviation of a prior",
          "[survey][linear_fit]") {
    constexpr double kRowSd = 2.0, kPriorSd = 5.0;  // Weight 0.4.
    const auto prior_of = [](double sd) {
        return SlopePriors{Eigen::VectorXd::Constant(1, -30.0),
                           Eigen::VectorXd::Constant(1, kRowSd / sd), kRowSd};
    };
    const Eigen::VectorXd constant = Eigen::VectorXd::Constant(6, 42.5);
    const auto by_prior = fit_linear(constant, kY, prior_of(kPriorSd)).value();
    const Eigen::VectorXd far = Eigen::VectorXd::Constant(1, 52.5);
    for (const double s : {0.0, 0.1, 2.0, 30.0}) {
        CHECK(std::sqrt(by_prior.covariance(s)(1, 1)) == Approx(kPriorSd));
        CHECK(by_prior.variance_at(far, s) ==
              Approx(s * s / 6.0 + 10.0 * 10.0 * kPriorSd * kPriorSd));
    }
    // A slope of two sources: b = (Sxy + w^2 m) / (Sxx + w^2), so
    // var(b) = (Sxx s^2 + w^4 sd^2) / (Sxx + w^2)^2.
    const auto by_both = fit_linear(kX, kY, prior_of(kPriorSd)).value();
    const double sxx = (kX.array() - kX.mean()).square().sum(), w2 = 0.16, s = 0.7;
    const double variance =
        (sxx * s * s + w2 * w2 * kPriorSd * kPriorSd) / ((sxx + w2) * (sxx + w2));
    CHECK(by_both.covariance(s)(1, 1) == Approx(variance));
    CHECK(by_both.covariance(s)(0, 1) == Approx(-kX.mean() * variance));
    CHECK(by_both.covariance(s)(0, 0) == Approx(s * s / 6.0 + kX.mean() * kX.mean() * variance));
    CHECK(by_both.variance_at(kX.head(1), s) ==
          Approx(s * s / 6.0 + std::pow(kX(0) - kX.mean(), 2) * variance));
    CHECK(by_both.covariance(kRowSd)(1, 1) == Approx(kRowSd * kRowSd * by_both.cofactor(1, 1)));
}
