#include "corrector/whole_day/day_adjustment.hpp"

#include "protocol/linear_algebra/symmetric_eigen.hpp"
#include "protocol/unit/calibration.hpp"
#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::whole_day;

namespace {

double squares(const std::array<double, kErrorSources>& parts_mgal) {
    return std::inner_product(parts_mgal.begin(), parts_mgal.end(), parts_mgal.begin(), 0.0);
}

}  // namespace

TEST_CASE("a difference is that of a fit without both references") {
    const auto record = kScattered.record();
    const auto stations = MadeUpDay::stations();
    const DayAdjustment system = adjust_day({&record, stations}).value();
    const FittedDay all(system);
    double worst_mgal = 0.0, worst_ratio = 0.0;
    for (const auto& [from, to] : {std::pair(0U, 7U), std::pair(3U, 9U), std::pair(2U, 5U)}) {
        const auto hidden = stations_without({from, to});
        const DayAdjustment own = adjust_day({&record, hidden}, &all.point).value();
        const FittedDay fit(own);
        const Estimate expected = own.difference(from, to), found = system.difference(from, to);
        CHECK(expected.value ==
              Approx(fit.gravity_mgal[to].value - fit.gravity_mgal[from].value).margin(1e-6));
        worst_mgal = std::max(worst_mgal, std::abs(found.value - expected.value));
        worst_ratio =
            std::max(worst_ratio, std::abs(found.standard_error / expected.standard_error - 1.0));
        CHECK(std::abs(found.value - (MadeUpDay::gravity_mgal(to) -
                                      MadeUpDay::gravity_mgal(from))) < 3.0 * found.standard_error);
    }
    INFO("values differ by up to " << worst_mgal << " mGal, errors by " << 100.0 * worst_ratio
                                   << " %");
    CHECK(worst_mgal < 0.1);
    CHECK(worst_ratio < 0.1);
}

TEST_CASE("the correlation of all stations is one of a covariance") {
    const auto record = kScattered.record();
    const auto stations = stations_without({3, 9});
    const DayAdjustment system = adjust_day({&record, stations}).value();
    const FittedDay fit(system);
    const Eigen::MatrixXd correlation = system.correlation();
    REQUIRE(correlation.rows() == static_cast<Eigen::Index>(MadeUpDay::kSites));
    CHECK((correlation.diagonal().array() - 1.0).abs().maxCoeff() < 1e-9);
    CHECK(correlation.cwiseAbs().maxCoeff() < 1.0 + 1e-9);
    CHECK(linear_algebra::symmetric_eigen(correlation).values(0) > -1e-9);
    // Both are unknown, so their difference has the variance of the joint posterior.
    const double a = fit.gravity_mgal[3].standard_error, b = fit.gravity_mgal[9].standard_error;
    CHECK(system.difference(3, 9).standard_error ==
          Approx(std::sqrt(a * a + b * b - 2.0 * a * b * correlation(3, 9))).epsilon(1e-4));
}

TEST_CASE("the only reference stays held, and differences do not need it") {
    const auto record = kScattered.record();
    auto stations = stations_without({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
    const DayAdjustment system = adjust_day({&record, stations}).value();
    const FittedDay fit(system);
    CHECK(system.correlation().row(0).norm() == 0.0);
    const Estimate difference = system.difference(0, 4);
    CHECK(difference.standard_error == Approx(fit.gravity_mgal[4].standard_error).epsilon(1e-4));
    CHECK(difference.value ==
          Approx(fit.gravity_mgal[4].value - fit.gravity_mgal[0].value).margin(1e-4));
    // An uncertain datum shifts every other station by as much.
    for (DayStation& station : stations) station.u_gravity = MilliGal(2.0);
    const DayAdjustment uncertain = adjust_day({&record, stations}).value();
    const FittedDay loose(uncertain);
    CHECK(loose.gravity_mgal[4].standard_error ==
          Approx(std::hypot(2.0, fit.gravity_mgal[4].standard_error)).epsilon(1e-3));
    CHECK(loose.gravity_mgal[4].parts_mgal.at(static_cast<std::size_t>(ErrorSource::datum)) ==
          Approx(2.0).epsilon(1e-3));
    CHECK(uncertain.correlation()(0, 4) ==
          Approx(2.0 / loose.gravity_mgal[4].standard_error).epsilon(1e-3));
}

TEST_CASE("the sources of an uncertainty add up to it") {
    const auto record = kScattered.record();
    const FittedDay fit = fit_day(record, stations_without({3, 9})).value();
    for (const std::size_t number : {3U, 9U}) {
        const GravityEstimate& gravity = fit.gravity_mgal[number];
        CHECK(squares(gravity.parts_mgal) ==
              Approx(gravity.standard_error * gravity.standard_error).epsilon(1e-9));
        // Placement: that of its own set-ups, and some of the others.
        const double set_ups = number == 3 ? 2.0 : 1.0;  // the day has 16 set-ups at 11 sites
        const double own_mgal = fit.noise.placement_mgal / std::sqrt(set_ups);
        CHECK(gravity.parts_mgal.front() > own_mgal);
        CHECK(gravity.parts_mgal.front() < 1.6 * own_mgal);
    }
    CHECK(squares(fit.gravity_mgal[0].parts_mgal) == 0.0);
}

TEST_CASE("a reference with an uncertainty gives way to the readings") {
    const auto record = kScattered.record();
    auto stations = MadeUpDay::stations();
    constexpr double kWrong_mgal = 20.0;
    for (DayStation& station : stations)
        if (station.number == 6) station.gravity = *station.gravity + MilliGal(kWrong_mgal);
    for (const double u_mgal : {0.0, 30.0}) {
        stations[6].u_gravity = MilliGal(u_mgal);
        const FittedDay fit = fit_day(record, stations).value();
        const double error = fit.gravity_mgal[6].value - MadeUpDay::gravity_mgal(6);
        if (u_mgal == 0.0)
            CHECK(error == Approx(kWrong_mgal));
        else
            CHECK(std::abs(error) < 3.0 * fit.gravity_mgal[6].standard_error);
    }
}

TEST_CASE("a gravity follows the references and the scale's prior as its shared errors say") {
    const auto record = kScattered.record();
    auto stations = stations_without({2, 3, 4, 5, 6, 7, 8, 9, 10});
    for (DayStation& station : stations) station.u_gravity = MilliGal(2.0);
    DayPriors priors = usual_day_priors();
    const FittedDay fit = fit_day(record, stations, nullptr, priors).value();
    const GravityEstimate& gravity = fit.gravity_mgal[9];
    // The values have the most likely noise, the errors the expected one.
    constexpr double kMargin = 0.02;
    double sum = 0.0;
    for (const std::size_t number : {0U, 1U}) {
        auto moved = stations;
        constexpr double kMove_mgal = 0.2;
        for (DayStation& station : moved)
            if (station.number == number) station.gravity = *station.gravity + MilliGal(kMove_mgal);
        const FittedDay other = fit_day(record, moved, &fit, priors).value();
        const double answer = (other.gravity_mgal[9].value - gravity.value) / kMove_mgal;
        CHECK(2.0 * answer == Approx(gravity.of_gravities_mgal[number]).margin(kMargin));
        CHECK(answer > 0.2);
        sum += gravity.of_gravities_mgal[number];
    }
    CHECK(sum == Approx(2.0).epsilon(1e-3));  // both together move every gravity
    CHECK(std::abs(gravity.of_gravities_mgal[5]) < 1e-3);
    constexpr double kMove = 0.25;  // deviations of the prior
    priors.set_scale(1.0 + kMove * unit::kUsualScaleDeviation, unit::kUsualScaleDeviation);
    const FittedDay other = fit_day(record, stations, &fit, priors).value();
    const double answer = (other.gravity_mgal[9].value - gravity.value) / kMove;
    CHECK(answer == Approx(gravity.shared_mgal.back()).margin(kMargin));
    CHECK(answer < -0.1);
}

TEST_CASE("the errors of the noise cover its scatter") {
    // The same day with other noise: ln(placement / 1.2) in units of its error.
    double sum = 0.0;
    constexpr int kDays = 20;
    for (std::uint64_t seed = 1; seed <= kDays; ++seed) {
        const FittedDay fit = fit_day(kScattered.record(seed), MadeUpDay::stations()).value();
        REQUIRE(fit.noise_log_errors);
        CHECK(fit.noise_log_errors->front() > 0.1);
        CHECK(fit.noise_log_errors->front() < 0.5);
        sum +=
            std::pow(std::log(fit.noise.placement_mgal / 1.2) / fit.noise_log_errors->front(), 2);
    }
    INFO("rms " << std::sqrt(sum / kDays) << " of the stated errors");
    CHECK(std::sqrt(sum / kDays) > 0.5);
    CHECK(std::sqrt(sum / kDays) < 1.6);
}
