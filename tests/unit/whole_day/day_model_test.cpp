#include "corrector/whole_day/day_model.hpp"

#include <cstdio>

#include "corrector/whole_day/unit_posterior.hpp"
#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

namespace {

void check_gravities(const DayFit& fit, double margin_mgal) {
    for (std::size_t s = 0; s < MadeUpDay::kSetUps; ++s)
        CHECK(fit.set_ups[s].corrected.value() ==
              Approx(MadeUpDay::gravity_mgal(s)).margin(margin_mgal));
}

}  // namespace

TEST_CASE("the whole-day model finds the parameters of made-up readings") {
    const MadeUpDay day;
    const DayRecord record = day.record();
    const auto fit = fit_day(record, MadeUpDay::stations());
    REQUIRE(fit);
    CHECK(fit->fast_lag_s == Approx(day.fast_lag_s).epsilon(0.01));
    CHECK(fit->slow_lag_s == Approx(day.slow_lag_s).epsilon(0.01));
    CHECK(coefficient(*fit, DayTerm::level).value == Approx(day.level).margin(0.1));
    CHECK(coefficient(*fit, DayTerm::slow).value == Approx(day.slow).margin(0.1));
    CHECK(coefficient(*fit, DayTerm::fast).value == Approx(day.fast).margin(0.02));
    CHECK(coefficient(*fit, DayTerm::drift).value == Approx(day.drift).margin(0.01));
    CHECK(coefficient(*fit, DayTerm::warm_up).value == Approx(day.warm_up).margin(0.3));
    const Estimate x = coefficient(*fit, DayTerm::x);
    CHECK(x.value == Approx(day.x).margin(3.0 * x.standard_error));
    CHECK(x.standard_error < 10.0);
    check_gravities(*fit, 0.001);
}

TEST_CASE("two faces separate what acts on the bias from what acts on the scale") {
    const MadeUpDay day{.has_two_faces = true, .scale_share = 0.3};
    const DayRecord record = day.record();
    CHECK(has_two_faces(record.bins));
    const auto fit = fit_day(record, MadeUpDay::stations());
    REQUIRE(fit);
    CHECK(coefficient(*fit, DayTerm::constant).value == Approx(day.constant).margin(0.01));
    CHECK(coefficient(*fit, DayTerm::level).value == Approx(day.level).margin(0.1));
    CHECK(coefficient(*fit, DayTerm::fast).value == Approx(day.fast).margin(0.02));
    CHECK(coefficient(*fit, DayTerm::drift).value == Approx(day.drift).margin(0.01));
    REQUIRE(fit->on_scale.size() == 5);
    CHECK(fit->on_scale[0].value == Approx(0.3 * day.level).margin(0.1));
    CHECK(fit->on_scale[1].value == Approx(0.3 * day.slow).margin(0.1));
    CHECK(fit->on_scale[2].value == Approx(0.3 * day.fast).margin(0.02));
    REQUIRE(fit->scale_share);
    CHECK(std::abs(fit->scale_share->value - 0.3) < 3.0 * fit->scale_share->standard_error);
    CHECK(fit->scale_share->standard_error < 0.15);
    check_gravities(*fit, 0.001);
}

TEST_CASE("a step of a day in two faces is one of the bias") {
    const MadeUpDay day{.has_two_faces = true};
    DayRecord record = day.record();
    constexpr std::size_t kFirst = 7;  // after the step; its set-ups are in both faces
    for (auto& bin : record.bins)
        if (bin.set_up >= kFirst) bin.reading = bin.reading + MilliGal(bin.face * 20.0);
    auto stations = MadeUpDay::stations();
    for (std::size_t s = kFirst; s < stations.size(); ++s) stations[s].steps = 1;
    const auto fit = fit_day(record, stations);
    REQUIRE(fit);
    CHECK(fit->steps_mgal.at(0).value == Approx(20.0).margin(0.05));
    check_gravities(*fit, 0.01);
}

TEST_CASE("reading, flicker and effects of a set-up add up to its corrected value") {
    const bool has_two_faces = GENERATE(false, true);
    const auto fit =
        fit_day(MadeUpDay{.placement_mgal = 1.0, .has_two_faces = has_two_faces}.record(),
                MadeUpDay::stations());
    for (const DaySetUp& set_up : fit.value().set_ups)
        CHECK(corrected_mgal(set_up) == Approx(set_up.corrected.value()).epsilon(1e-12));
}

TEST_CASE("the stated uncertainty of unknown stations covers their errors as often as it should") {
    // Stations 3 and 9 of 40 days with a set-up scatter of 1.2 mGal.
    std::size_t count = 0, within = 0;
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        auto stations = MadeUpDay::stations();
        for (const std::size_t s : {3U, 9U}) {
            stations[s].gravity.reset();
            stations[s].number = s == 3U ? 11U : 12U;  // set-up 14 is at site 3 too
        }
        const auto fit = fit_day(kScattered.record(seed), stations);
        for (std::size_t k = 0; k < 2; ++k) {
            const Estimate g = fit.value().gravity_mgal.at(11 + k);
            const double error = g.value - MadeUpDay::gravity_mgal(k == 0 ? 3 : 9);
            sum += error * error;
            ++count;
            if (std::abs(error) <= g.standard_error) ++within;
        }
    }
    INFO("rms " << std::sqrt(sum / static_cast<double>(count)) << " mGal, within the stated "
                << within << " of " << count);
    CHECK(std::sqrt(sum / static_cast<double>(count)) < 1.6);
    CHECK(within >= 44);  // 55 to 85 %
    CHECK(within <= 68);
}

TEST_CASE("the tide is taken off every bin, and a set-up has the mean of its bins") {
    DayRecord record = MadeUpDay{.placement_mgal = 1.0}.record();
    const auto stations = stations_without({5});
    const auto without = fit_day(record, stations);
    for (std::size_t i = 0; i < record.bins.size(); ++i) {
        record.bins[i].tide = MilliGal(0.2 * std::sin(0.1 * static_cast<double>(i)));
        record.bins[i].reading = record.bins[i].reading + record.bins[i].tide;
    }
    const auto with = fit_day(record, stations);
    // With other last bits the search may end a step of its grid away.
    for (std::size_t s = 0; s < MadeUpDay::kSetUps; ++s) {
        double mean = 0.0;
        for (std::size_t b = 0; b < MadeUpDay::kBins; ++b)
            mean += record.bins[s * MadeUpDay::kBins + b].tide.value() / MadeUpDay::kBins;
        CHECK(with.value().set_ups[s].tide.value() == Approx(mean).margin(1e-12));
        CHECK((with->set_ups[s].reading - without.value().set_ups[s].reading).value() ==
              Approx(mean).margin(1e-6));
        CHECK(with->set_ups[s].corrected.value() ==
              Approx(without->set_ups[s].corrected.value()).epsilon(0.0).margin(1e-3));
    }
}

TEST_CASE("a planned day has the uncertainties of a measured one of the same unit and noise") {
    const auto stations = stations_without({3, 9});  // set-up 14 is at site 3 too
    const DayRecord measured = kScattered.record();
    DayPriors usual = usual_day_priors();
    usual.set_scale(1.0, 1e-6);  // the plan does not know where the unknown stations are
    const FittedDay fit = fit_day(measured, stations, nullptr, usual).value();

    // The plan uses the results of the day: the means of the priors and the size of the biases.
    const UnitPosterior found = unit_posterior(fit, usual);
    DayPriors priors = usual;
    priors.mean = found.priors().mean;
    for (std::size_t k = 0; k < kDayTerms; ++k)
        priors.mean(DayPriors::place_of(static_cast<DayTerm>(k))) = fit.coefficients.at(k).value;
    for (const DayTerm axis : {DayTerm::x, DayTerm::y})
        priors.factor.row(DayPriors::place_of(axis)) *=
            std::pow(usual.bias_factor, fit.expected[5]);
    priors.bias_factor = 1.0;
    DayRecord plan = measured;
    for (DayBin& bin : plan.bins) bin.reading = MilliGal(0.0);
    const FittedDay planned(
        adjust_planned_day(plan, {nullptr, stations, priors}, found.noise).value());
    for (const std::size_t number : {3U, 9U}) {
        const GravityEstimate &one = planned.gravity_mgal[number],
                              &other = fit.gravity_mgal[number];
        CHECK(one.standard_error == Approx(other.standard_error).epsilon(1e-3));
        for (std::size_t k = 0; k < kErrorSources; ++k)
            CHECK(one.parts_mgal.at(k) == Approx(other.parts_mgal.at(k)).margin(2e-3));
    }
    for (std::size_t k = 0; k < kDayTerms; ++k)
        CHECK(planned.coefficients.at(k).value ==
              Approx(priors.mean(DayPriors::place_of(static_cast<DayTerm>(k)))).margin(1e-3));
}

TEST_CASE("a measured share of the scale makes a turned day more certain") {
    const auto u_with = [](const unit::ScaleShare& share, bool has_two_faces) {
        DayRecord record = MadeUpDay{.has_two_faces = has_two_faces}.record();
        const auto stations = stations_without({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
        DayPriors priors = usual_day_priors();
        priors.scale_share = share;
        const FittedDay fit(
            adjust_planned_day(record, {nullptr, stations, priors}, kUsualNoise).value());
        return fit.gravity_mgal[5].standard_error;
    };
    const unit::ScaleShare measured{0.0, 1e-3, true};
    CHECK(u_with(measured, true) < 0.9 * u_with({}, true));
    CHECK(u_with(measured, false) == u_with({}, false));
}

TEST_CASE("a day finds the scale of its sensor, and the unknown stations with it") {
    DayRecord record = MadeUpDay{.white_mgal = 0.01}.record();
    for (DayBin& bin : record.bins)
        bin.reading =
            bin.reading + MilliGal(0.02 * (MadeUpDay::gravity_mgal(bin.set_up) - 979900.0));
    const auto stations = stations_without({3});
    DayPriors priors = usual_day_priors();
    priors.set_scale(1.0, 0.05);
    const FittedDay fit = fit_day(record, stations, nullptr, priors).value();
    const Estimate& scale = coefficient(fit, DayTerm::scale);
    std::printf("scale %.6f +- %.6f, unknown station off by %.4f mGal\n", 1.0 + scale.value,
                scale.standard_error, fit.gravity_mgal[3].value - MadeUpDay::gravity_mgal(3));
    CHECK(std::abs(scale.value - 0.02) < 3.0 * scale.standard_error);
    CHECK(scale.standard_error < 0.01);
    CHECK(std::abs(fit.gravity_mgal[3].value - MadeUpDay::gravity_mgal(3)) <
          3.0 * fit.gravity_mgal[3].standard_error);
    CHECK(corrected_mgal(fit.set_ups[3]) - fit.set_ups[3].corrected.value() ==
          Approx(0.0).margin(1e-9));

    // A scale that is held at 1 moves the unknown station by the error that it hides.
    priors.set_scale(1.0, 1e-6);
    const FittedDay held = fit_day(record, stations, nullptr, priors).value();
    CHECK(held.gravity_mgal[3].parts_mgal.at(static_cast<std::size_t>(ErrorSource::scale)) < 1e-3);
    CHECK(held.noise.placement_mgal > 2.0 * fit.noise.placement_mgal);
}

TEST_CASE("what a day has found of its unit is the prior of the next") {
    const DayRecord record = kScattered.record();
    const DayPriors usual = usual_day_priors();
    const FittedDay fit = fit_day(record, MadeUpDay::stations(), nullptr, usual).value();
    const UnitPosterior found = unit_posterior(fit, usual);
    const DayPriors next = found.priors();
    const DayPriors::Matrix covariance = next.factor * next.factor.transpose();
    for (const DayTerm term :
         {DayTerm::level, DayTerm::slow, DayTerm::fast, DayTerm::x, DayTerm::y}) {
        const Estimate& estimate = coefficient(fit, term);
        const auto place = DayPriors::place_of(term);
        CHECK(next.mean(place) == Approx(estimate.value));
        CHECK(std::sqrt(covariance(place, place)) == Approx(estimate.standard_error).epsilon(1e-6));
    }
    for (const std::size_t lag : {0U, 1U}) {
        const auto place = static_cast<Eigen::Index>(lag);
        CHECK(std::sqrt(covariance(place, place)) ==
              Approx(fit.lag_log_errors.at(lag)).epsilon(1e-6));
    }
    CHECK(std::exp(next.mean(0)) == Approx(fit.fast_lag_s));
    CHECK(found.noise.placement_mgal > fit.noise.placement_mgal);  // the expected variance
    CHECK(found.noise.white_mgal == Approx(fit.noise.white_mgal));
}

TEST_CASE("set-ups of one unknown station share its value") {
    // Set-ups 2 and 13 are both at the third of eleven stations.
    const auto fit = fit_day(MadeUpDay{.placement_mgal = 1.0}.record(), stations_without({2}));
    const double g = fit.value().gravity_mgal.at(2).value;
    CHECK(g == Approx(MadeUpDay::gravity_mgal(2)).margin(2.5));
    const double departure2 = fit->set_ups[2].corrected.value() - g,
                 departure13 = fit->set_ups[13].corrected.value() - g;
    CHECK(departure2 == Approx(-departure13).margin(1e-6));
    CHECK(std::abs(departure2) > 0.05);
}

TEST_CASE("the whole-day model is refused without a known station") {
    CHECK_FALSE(
        fit_day(MadeUpDay{}.record(), stations_without({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10})));
}

TEST_CASE("a fit that starts from a nearby fit gives the same result") {
    const DayRecord record = MadeUpDay{.placement_mgal = 1.0, .white_mgal = 0.2}.record();
    const auto stations = stations_without({5});
    const auto all = fit_day(record, MadeUpDay::stations());
    const auto afar = fit_day(record, stations), near = fit_day(record, stations, &all.value());
    CHECK(near.value().gravity_mgal.at(5).value ==
          Approx(afar.value().gravity_mgal.at(5).value).margin(0.005));
    CHECK(near->gravity_mgal.at(5).standard_error ==
          Approx(afar->gravity_mgal.at(5).standard_error).epsilon(0.005));
}

TEST_CASE("the whole-day fit is bit-identical each time") {
    const DayRecord record = MadeUpDay{.placement_mgal = 1.0}.record();
    const auto a = fit_day(record, MadeUpDay::stations()),
               b = fit_day(record, MadeUpDay::stations());
    CHECK(a.value().point == b.value().point);
    for (std::size_t s = 0; s < MadeUpDay::kSetUps; ++s)
        CHECK(a->set_ups[s].corrected == b->set_ups[s].corrected);
}

TEST_CASE("narrower priors determine what the day does not determine") {
    // Level and slow slope are known to 2 mGal/degC each and better together, x to 1 mGal/g.
    DayPriors priors = usual_day_priors();
    priors.free_axes();
    const auto level = DayPriors::place_of(DayTerm::level);
    const auto slow = DayPriors::place_of(DayTerm::slow), x = DayPriors::place_of(DayTerm::x);
    Eigen::Matrix3d covariance = Eigen::Vector3d(4.0, 4.0, 1.0).asDiagonal();
    covariance(0, 1) = covariance(1, 0) = -3.9;  // their sum is known to 0.4
    priors.observe({level, slow, x}, Eigen::Vector3d(-14.0, -26.0, 900.5), covariance);
    const auto usual = fit_day(kScattered.record(), MadeUpDay::stations());
    const auto fit = fit_day(kScattered.record(), MadeUpDay::stations(), nullptr, priors);
    REQUIRE(fit);
    CHECK(coefficient(*fit, DayTerm::level).value + coefficient(*fit, DayTerm::slow).value ==
          Approx(-40.0).margin(1.2));
    CHECK(coefficient(*fit, DayTerm::x).value == Approx(900.5).margin(0.2));
    CHECK(coefficient(*fit, DayTerm::x).standard_error == Approx(1.0).margin(0.01));
    CHECK(coefficient(*fit, DayTerm::level).standard_error <= Approx(2.0));
    CHECK(coefficient(*usual, DayTerm::x).standard_error > 50.0);
    // Each estimate is the mean of its prior plus the shift.
    const DayPriors::Vector moved = priors.mean + priors.factor * fit->shift;
    CHECK(moved(level) == Approx(coefficient(*fit, DayTerm::level).value));
    CHECK(moved(slow) == Approx(coefficient(*fit, DayTerm::slow).value));
    CHECK(std::exp(moved(0)) == Approx(fit->fast_lag_s));
    const DayPriors::Matrix left =
        priors.factor * fit->shift_covariance * priors.factor.transpose();
    CHECK(std::sqrt(left(slow, slow)) == Approx(coefficient(*fit, DayTerm::slow).standard_error));
}

TEST_CASE("a prior from an arbitrarily exact measurement is accepted") {
    const auto x = DayPriors::place_of(DayTerm::x);
    for (const double variance : {1.0, 1e-10, 1e-20}) {
        DayPriors priors = usual_day_priors();
        priors.observe({x}, Eigen::VectorXd::Constant(1, 900.0),
                       Eigen::MatrixXd::Constant(1, 1, variance));
        CHECK(priors.factor(x, x) == Approx(std::sqrt(variance)).epsilon(1e-5));
        CHECK(priors.factor.allFinite());
        CHECK(priors.mean(x) == Approx(900.0).margin(1e-3));
    }
}

TEST_CASE("a lag that is correlated with a slope changes together with it") {
    // The fast lag's logarithm changes by 1 when the slope changes by 10.
    const MadeUpDay day;
    DayPriors priors = usual_day_priors();
    Eigen::Matrix2d covariance;
    covariance << 0.04, 0.4, 0.4, 4.0 + 1e-6;
    priors.observe({0, DayPriors::place_of(DayTerm::fast)}, Eigen::Vector2d(std::log(45.0), 7.0),
                   covariance);
    const auto fit = fit_day(day.record(), MadeUpDay::stations(), nullptr, priors);
    REQUIRE(fit);
    CHECK(std::log(fit->fast_lag_s / 45.0) * 10.0 ==
          Approx(coefficient(*fit, DayTerm::fast).value - 7.0).margin(0.01));
    CHECK(fit->fast_lag_s == Approx(day.fast_lag_s).epsilon(0.01));
}

TEST_CASE("biases far above the usual size are not taken for placement") {
    // The data sheet allows 2 Gal, the day has 20.
    const MadeUpDay day{.x = -14000.0, .placement_mgal = 1.2, .white_mgal = 0.2};
    constexpr double kY_mgal_per_g = 15000.0;
    // A search from small biases ends at 26 to 28 mGal on these of the first thirty seeds.
    for (const std::uint64_t seed : {8U, 15U, 24U}) {
        auto record = day.record(seed);
        for (corrector::reading::DayBin& bin : record.bins) {
            // The golden angle spreads the tilts evenly.
            bin.y = StandardGravity(0.002 * std::sin(2.4 * static_cast<double>(bin.set_up + seed)));
            bin.reading = bin.reading + MilliGal(kY_mgal_per_g * bin.y.value());
        }
        const FittedDay fit = fit_day(record, MadeUpDay::stations()).value();
        CAPTURE(seed, coefficient(fit, DayTerm::x).value);
        CHECK(fit.noise.placement_mgal < 3.0);
    }
}
