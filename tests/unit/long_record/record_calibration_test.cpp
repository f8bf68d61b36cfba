/// The thermal part and the warm-up of a calibration from simulated records.
#include <cmath>

#include "corrector/long_record/record_calibration.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/symmetric_eigen.hpp"
#include "tests/support/two_path_truth.hpp"
#include "tests/unit/long_record/simulated_record.hpp"

using namespace a351;
using namespace a351::corrector::long_record;
using namespace a351::unit;
using linear_algebra::Cholesky;

namespace {

/// Returns the true parameters in the order of kThermalNames.
Eigen::Matrix<double, 5, 1> true_values(const sim::TwoPathTruth& truth) {
    Eigen::Matrix<double, 5, 1> values;
    values << truth[TwoPathTerm::level], truth[TwoPathTerm::slow], truth[TwoPathTerm::fast],
        std::log(truth[TwoPathTerm::fast_lag]), std::log(truth[TwoPathTerm::slow_lag]);
    return values;
}

/// Returns the variance of the best-known direction, in units of the priors' variances.
double best_variance(const ThermalResponse& response) {
    Eigen::Matrix<double, 5, 5> scaled = response.covariance;
    for (Eigen::Index k = 0; k < 5; ++k) {
        const double deviation = record_prior(static_cast<ThermalTerm>(k)).deviation;
        scaled.row(k) /= deviation;
        scaled.col(k) /= deviation;
    }
    return linear_algebra::symmetric_eigen(scaled).values(0);
}

TwoPathFit shifted(TwoPathFit fit, TwoPathTerm term, double by) {
    fit.parameters.at(static_cast<std::size_t>(term)).value += by;
    return fit;
}

/// Returns a fit of which only the size and time of the warm-up are used.
TwoPathFit warm_up_fit(double size_mgal, double size_error, double time_h, double log_error) {
    TwoPathFit fit = fitted("indoor", 701);
    const auto set = [&fit](TwoPathTerm term, double value, double error, double deviation) {
        FittedParameter& parameter = fit.parameters.at(static_cast<std::size_t>(term));
        parameter.value = value;
        parameter.standard_error = error;
        parameter.is_determined = true;
        const auto place = static_cast<Eigen::Index>(term);
        fit.covariance.row(place).setZero();
        fit.covariance.col(place).setZero();
        fit.covariance(place, place) = deviation * deviation;
    };
    set(TwoPathTerm::warm_up, size_mgal, size_error, size_error);
    set(TwoPathTerm::warm_up_time, 3600.0 * time_h, 3600.0 * time_h * log_error, log_error);
    return fit;
}

}  // namespace

TEST_CASE("a night calibrates the fast path and leaves the rest undetermined") {
    const sim::scenario::Scenario scenario = of_drawn_units("indoor");
    const PooledThermal pooled = pool_thermal({fitted(scenario, 702)});
    REQUIRE(pooled.response);
    CHECK(pooled.parameters[2].is_determined);
    CHECK_FALSE(pooled.parameters[4].is_determined);
    CHECK_FALSE(pooled.parameters[4].needed.empty());
    const auto& [values, covariance] = *pooled.response;
    const Cholesky factor(covariance);
    CHECK(factor.is_positive_definite());
    // The slow lag's prior, a factor of 2, must not appear in the result.
    CHECK(std::sqrt(covariance(4, 4)) > 10.0 * std::log(2.0));
    const Eigen::VectorXd off = values - true_values(sim::two_path_truth(scenario, 702));
    const double square = factor.half_solve(off).squaredNorm();
    CAPTURE(values.transpose(), square);
    CHECK(square <
          4.0 * 15.1);  // 99 % quantile of chi-square with 5 degrees of freedom, errors doubled
}

TEST_CASE("the errors stated by calibrations cover the true unit in nine of ten cases") {
    // A survey doubles the errors. The 95 % quantile of chi-square with 5 degrees of freedom is
    // 11.07.
    constexpr double kMost = kThermalErrorFactor * kThermalErrorFactor * 11.07;
    constexpr int kUnits = 20;
    const sim::scenario::Scenario scenario = of_drawn_units("indoor");
    int held = 0;
    for (std::uint64_t seed = 711; seed < 711 + kUnits; ++seed) {
        const PooledThermal pooled = pool_thermal({fitted(scenario, seed)});
        REQUIRE(pooled.response);
        const auto& [values, covariance] = *pooled.response;
        const Eigen::VectorXd off = values - true_values(sim::two_path_truth(scenario, seed));
        const double square = Cholesky(covariance).half_solve(off).squaredNorm();
        UNSCOPED_INFO(seed << ": " << square << " of " << kMost);
        held += square < kMost ? 1 : 0;
    }
    CHECK(held >= 18);
}

TEST_CASE("a calibration does not contain the priors of the fit") {
    // Combined with the fit's priors, the calibration gives the fit again in the directions it
    // contains.
    const TwoPathFit week = fitted("week", 703);
    const PooledThermal pooled = pool_thermal({week});
    REQUIRE(pooled.response);
    Eigen::Matrix<double, 5, 5> information = Cholesky(pooled.response->covariance).inverse();
    for (Eigen::Index k = 0; k < 5; ++k)
        information(k, k) += std::pow(record_prior(static_cast<ThermalTerm>(k)).deviation, -2.0);
    const double error = std::sqrt(Cholesky(information).inverse()(2, 2));
    const double of_fit = week[TwoPathTerm::fast].standard_error;
    CHECK(error > 0.999 * of_fit);
    CHECK(error < 1.15 * of_fit);  // the calibration does not contain all directions
}

TEST_CASE("two equal records halve the variance, and contradicting records are detected") {
    const TwoPathFit night = fitted("indoor", 704);
    const PooledThermal one = pool_thermal({night}), two = pool_thermal({night, night});
    CHECK(two.parameters[2].standard_error < one.parameters[2].standard_error);
    REQUIRE((one.response && two.response));
    CHECK(best_variance(*two.response) == Approx(0.5 * best_variance(*one.response)));
    CHECK(one.agreement_p == 1.0);
    CHECK(two.agreement_p > 0.99);
    const double far = 20.0 * night[TwoPathTerm::fast].standard_error;
    CHECK(pool_thermal({night, shifted(night, TwoPathTerm::fast, far)}).agreement_p < 0.01);
}

TEST_CASE(
    "a record at constant temperature calibrates nothing, and the reason says what is needed") {
    RecordSegment segment = simulated_segment("indoor", 705);
    for (std::size_t i = 0; i < segment.size(); ++i)
        segment.temperature_degc[i] = 42.5 + 0.0015 * std::sin(0.7 * static_cast<double>(i * i));
    const std::string lack =
        reason_against_two_paths(segment.temperature_degc, segment.quantity, kRecordStep_s);
    CHECK_THAT(lack, ContainsSubstring("no response") && ContainsSubstring("needed: "));
    segment = simulated_segment("indoor", 705);
    CHECK(reason_against_two_paths(segment.temperature_degc, segment.quantity, kRecordStep_s) ==
          "");
}

TEST_CASE("a fit that does not determine rate and static slope calibrates nothing") {
    TwoPathFit fit = fitted("indoor", 706);
    fit.covariance.setIdentity();
    for (std::size_t k = 0; k < kThermalTerms; ++k) {
        const auto place = static_cast<Eigen::Index>(kThermalOfTwoPath.at(k));
        fit.covariance(place, place) =
            0.9 * std::pow(record_prior(static_cast<ThermalTerm>(k)).deviation, 2.0);
    }
    for (FittedParameter& parameter : fit.parameters) parameter.needed = "more";
    const PooledThermal pooled = pool_thermal({fit});
    CHECK_FALSE(pooled.response);
    for (const FittedParameter& parameter : pooled.parameters)
        CHECK_FALSE(parameter.needed.empty());
}

TEST_CASE("the warm-up ends when its exponential has fallen to the tolerance") {
    const TwoPathFit fit = warm_up_fit(-36.0, 1e-6, 2.5, 1e-6);
    const WarmUpReading at_once = warm_up_guidance(fit, 0.0, 12.0, 1.0);
    REQUIRE(at_once.guidance);
    CHECK(at_once.guidance->within_mgal == 1.0);
    CHECK(at_once.guidance->after_power_on_h == Approx(2.5 * std::log(36.0)).margin(1e-4));
    const WarmUpReading later = warm_up_guidance(fit, 0.5, 12.0, 3.0);
    REQUIRE(later.guidance);
    CHECK(later.guidance->after_power_on_h == Approx(0.5 + 2.5 * std::log(12.0)).margin(1e-4));
    // ln(time) known to 10 %, size to 1 mGal: 0.9 h and 0.07 h.
    const WarmUpReading unsure = warm_up_guidance(warm_up_fit(36.0, 1.0, 2.5, 0.1), 0, 12, 1.0);
    REQUIRE(unsure.guidance);
    CHECK(unsure.guidance->after_power_on_h == Approx(8.959 + 1.645 * 0.8986).margin(1e-3));
}

TEST_CASE("a warm-up that the record does not show is refused with the reason") {
    const WarmUpReading small = warm_up_guidance(warm_up_fit(5.0, 4.0, 2.5, 0.1), 0, 12, 1.0);
    CHECK_FALSE(small.guidance);
    CHECK_THAT(small.words, ContainsSubstring("switched on"));
    const WarmUpReading cut = warm_up_guidance(warm_up_fit(36.0, 1.0, 2.5, 0.1), 0, 6.0, 1.0);
    CHECK_FALSE(cut.guidance);
    CHECK_THAT(cut.words, ContainsSubstring("ends before"));
    TwoPathFit open = warm_up_fit(36.0, 1.0, 2.5, 0.1);
    open.parameters.at(static_cast<std::size_t>(TwoPathTerm::warm_up_time)).is_determined = false;
    CHECK_FALSE(warm_up_guidance(open, 0, 12, 1.0).guidance);
}
