// One adjustment against plain dense matrices.
#include "tests/support/long_tests.hpp"

#include "tests/unit/whole_day/dense_days.hpp"

using namespace a351;
using namespace a351::corrector::whole_day;

namespace {

/// Names of the columns that a system lacks: those of hidden references, and own ones of the others.
std::set<std::string> lacking(const DayAdjustment& adjustment,
                              const std::set<std::size_t>& hidden) {
    std::set<std::string> names;
    for (std::size_t site = 0; site < adjustment.problem().gravity_count(); ++site) {
        const bool is_own = adjustment.is_held(site) && hidden.contains(site);
        names.insert(is_own ? Dense::gravity(site) : Dense::own(site));
    }
    return names;
}

/// Largest differences between an adjustment and dense matrices.
struct Worst {
    double value_mgal = 0.0, left_out_mgal = 0.0, u = 0.0;  ///< u: relative.
    void add(double& worst, double found, Real expected, double unit = 1.0) const {
        worst = std::max(worst, std::abs(found - static_cast<double>(expected)) / unit);
    }
};

/// Compares gravities and differences of one problem.
void compare(const RandomDays& days, bool has_lags, Worst& worst) {
    const DayAdjustment adjustment(days.problem,
                                   {days.point, days.point, std::nullopt, std::nullopt});
    Dense dense(days);
    if (has_lags) dense.add_lags(adjustment);
    const std::vector<DaySurvey>& surveys = days.problem->surveys();
    // A gravity is the sum of its column and its own one, of which a system has one or none.
    const auto parts_of = [&](const Dense::Solution& system, std::size_t site) {
        Vector parts = Vector::Zero(std::ssize(system.names));
        const double deviation = adjustment.is_held(site) ? *days.u_held[site] : kFreeGravity_mgal;
        for (std::size_t k = 0; k < system.names.size(); ++k)
            if (system.names[k] == Dense::gravity(site))
                parts(static_cast<Eigen::Index>(k)) = deviation;
            else if (system.names[k] == Dense::own(site))
                parts(static_cast<Eigen::Index>(k)) = kFreeGravity_mgal;
        return parts;
    };
    const auto compare_u = [&](double found, const Dense::Solution& system, const Vector& parts) {
        const Real expected = std::sqrt(parts.dot(system.covariance * parts));
        worst.add(worst.u, found, expected, std::max(0.01, found));
    };
    const Dense::Solution all = dense.solve(lacking(adjustment, {}));
    // Estimates are (1 + k) times their distance from the base.
    const double scale =
        surveys.empty()
            ? 1.0
            : 1.0 + coefficient(adjustment.fit(surveys.size() - 1), DayTerm::scale).value;
    std::vector<std::size_t> held;
    for (std::size_t site = 0; site < MadeUpDay::kSites; ++site) {
        if (!dense.has(site)) continue;
        if (adjustment.is_held(site)) held.push_back(site);
        const GravityEstimate gravity = adjustment.gravity(site);
        const Vector parts = parts_of(all, site);
        compare_u(gravity.standard_error, all, parts);
        if (!has_lags)
            worst.add(worst.value_mgal, (gravity.value - days.base_mgal[site]) * scale,
                      parts.dot(all.values));
    }
    const auto hide = [&](const std::set<std::size_t>& hidden, std::size_t from, std::size_t to,
                          const Estimate& found, double fitted_mgal) {
        const Dense::Solution system = dense.solve(lacking(adjustment, hidden));
        const auto change = [&](std::size_t site) -> Real {
            return parts_of(system, site).dot(system.values) - parts_of(all, site).dot(all.values);
        };
        Vector parts = parts_of(system, to);
        Real changed = change(to);
        if (from != to) {
            parts -= parts_of(system, from);
            changed -= change(from);
        }
        compare_u(found.standard_error, system, parts);
        if (!has_lags) worst.add(worst.left_out_mgal, (found.value - fitted_mgal) * scale, changed);
    };
    for (std::size_t k = 0; k < std::min<std::size_t>(3, held.size()); ++k)
        if (held.size() > 1)
            hide({held[k]}, held[k], held[k], adjustment.left_out(held[k]),
                 adjustment.value_mgal(held[k]));
    if (held.size() > 2)
        hide({held[0], held[1]}, held[0], held[1], adjustment.difference(held[0], held[1]),
             adjustment.value_mgal(held[1]) - adjustment.value_mgal(held[0]));
}

}  // namespace

TEST_CASE("gravities of days, with and without their references, are those of dense matrices") {
    Worst worst;
    const std::uint64_t problems = test::is_long() ? 500 : 80;
    for (std::uint64_t seed = 1; seed <= problems; ++seed)
        compare(random_days(seed, 1e-9), false, worst);  // the lags are known: all is linear
    // The prior of a free gravity, 1e4 mGal, costs six digits of what a hidden reference changes, and a
    // hidden reference of 0.001 mGal six of its u.  Beside white readings of 0.01 mGal it costs one digit
    // of a value.
    CHECK(worst.value_mgal < 1e-8);
    CHECK(worst.left_out_mgal < 1e-6);
    CHECK(worst.u < 1e-8);
}

TEST_CASE("the uncertainty of gravities contains that of the lags") {
    Worst worst;
    const std::uint64_t problems = test::is_long() ? 50 : 20;
    for (std::uint64_t seed = 1; seed <= problems; ++seed)
        compare(random_days(1000 + seed, 1.0), true, worst);
    CHECK(worst.u < 1e-8);
}

TEST_CASE("the likelihood and the gravities of a box are those of dense matrices") {
    std::vector<DayRecord> records = box_of(2, 0.5, 5);
    records[0] = with_outer_oven(records[0], 2.0, 5.0);
    const std::vector<std::size_t> unknown{3, 5, 9};
    const std::vector<DaySurvey> surveys{survey_of(records[0], 0, stations_without(unknown)),
                                         survey_of(records[1], 1, stations_without(unknown))};
    std::vector<double> rough_mgal;
    std::set<std::string> own;
    for (std::size_t s = 0; s < MadeUpDay::kSites; ++s) {
        rough_mgal.push_back(MadeUpDay::gravity_mgal(s) + 0.5);
        own.insert(Dense::own(s));
    }
    RandomDays days;
    days.problem = std::make_shared<const DayProblem>(surveys, rough_mgal);
    const DayProblem& problem = *days.problem;
    REQUIRE(problem.groups().size() == 1);
    // Both lags of either unit; placement; flicker and white noise of either survey; size of the biases,
    // lag and size of the outer oven's effect of the first unit; size of the biases of the second.
    const std::vector<DayPoint> points{
        {{0.1, -0.2, -0.4, 0.2, 0.2, -1.0, 0.1, -0.5, 0.0, 0.3, 0.6, 0.4, 0.0}, 0.6},
        {{0.1, -0.2, -0.4, 0.2, 0.7, -1.0, 0.1, -0.5, 0.2, 0.3, 0.0, 0.0, 0.0}, 1.0},
        {std::vector<double>(13), 0.0}};
    REQUIRE(problem.hypers().size() == points.front().u.size());
    // Lags, placement, flicker, white, size of the biases, lag and size of the outer oven's effect.
    CHECK(problem.part_of(points[0], 0) == SurveyPoint{0.1, -0.2, 0.2, -1.0, 0.1, 0.3, 0.6, 0.4});
    CHECK(problem.part_of(points[0], 1) == SurveyPoint{-0.4, 0.2, 0.2, -0.5, 0.0, 0.0, 0.0, 0.0});
    for (const DayPoint& point : points) {
        std::vector<DayProblem::Normal> normals;
        std::vector<Eigen::MatrixXd> scaled;
        for (std::size_t k = 0; k < surveys.size(); ++k) {
            scaled.push_back(problem.of(k).scaled(problem.part_of(point, k)));
            normals.push_back(problem.of_survey(point, k, scaled[k]));
        }
        const auto reduced = problem.reduced(problem.of_group(normals, 0), 0);
        days.point = point;
        const Dense::Solution expected = Dense(days).solve(own);
        CHECK(2.0 * problem.cost(point, reduced) ==
              Approx(static_cast<double>(expected.twice_cost)).margin(1e-3));
        const auto solution = problem.solve(point, scaled).surveys;
        for (const std::size_t number : unknown) {
            const auto name = std::ranges::find(expected.names, Dense::gravity(number));
            REQUIRE(name != expected.names.end());
            const Real gravity = expected.values(name - expected.names.begin());
            for (const std::size_t k : {0U, 1U})
                CHECK(kFreeGravity_mgal * solution[k](problem.of(k).place_of(number)) ==
                      Approx(static_cast<double>(kFreeGravity_mgal * gravity)).margin(1e-4));
        }
    }
}
