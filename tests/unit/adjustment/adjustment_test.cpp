#include "corrector/adjustment/adjustment.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <random>
#include "tests/support/long_tests.hpp"

#include "tests/unit/adjustment/dense_oracle.hpp"

using namespace a351;
using namespace a351::corrector::adjustment;

namespace {

/// Random numbers that are the same on every machine.
class Draw {
public:
    explicit Draw(std::uint64_t seed) : generator_(seed) {}
    /// Returns a number of [low, high).
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1p-53;
    }
    /// Returns a whole number of [low, high].
    std::size_t count(std::size_t low, std::size_t high) {
        return low + generator_() % (high - low + 1);
    }
    bool is(double probability) { return between(0.0, 1.0) < probability; }

private:
    std::mt19937_64 generator_;
};

/// A campaign: loops with constant and drift, a scale of each meter, a temperature, steps.
Equations random_problem(std::uint64_t seed) {
    Draw draw(seed);
    Equations equations;
    equations.stations = draw.count(1, 25);
    const std::size_t meters = draw.count(1, 4), loops = draw.count(1, 12),
                      degree = draw.count(0, 2);
    const bool has_temperature = draw.is(0.5);
    std::vector<double> gravity_mgal(equations.stations);
    for (double& one : gravity_mgal) one = draw.between(-200.0, 200.0);
    const std::size_t of_loops = loops * (degree + 1), temperature = of_loops,
                      scales = temperature + (has_temperature ? 1 : 0), steps = scales + meters;
    equations.terms = steps;
    const auto term = [&](std::size_t k, double factor) {
        return Entry{equations.unknown_of_term(k), factor};
    };
    for (std::size_t loop = 0; loop < loops; ++loop) {
        const std::size_t meter = loop % meters, readings = draw.count(4, 14);
        const bool has_step = readings > 6 && draw.is(0.2);
        const std::size_t step = has_step ? equations.terms++ : 0;
        double hours = draw.between(-5.0, -4.0);
        for (std::size_t i = 0; i < readings; ++i) {
            hours += draw.between(0.1, 0.9);
            const std::size_t station = draw.count(0, equations.stations - 1);
            Equation& row = equations.rows.emplace_back();
            row.sd = draw.between(0.5, 3.0) * (draw.is(0.3) ? 0.01 : 1.0);
            row.unknowns = {{station, draw.between(0.999, 1.001)},
                            term(loop * (degree + 1), 1.0),
                            term(scales + meter, gravity_mgal[station])};
            for (std::size_t power = 1; power <= degree; ++power)
                row.unknowns.push_back(
                    term(loop * (degree + 1) + power, std::pow(hours, static_cast<double>(power))));
            if (has_temperature) row.unknowns.push_back(term(temperature, draw.between(-0.3, 0.4)));
            if (has_step && i >= readings / 2) row.unknowns.push_back(term(step, 1.0));
            row.value = draw.between(-900000.0, 900000.0);
        }
    }
    const auto prior = [&](std::size_t k, double sd) {
        equations.rows.push_back({draw.between(-1.0, 1.0), sd, {term(k, 1.0)}, false});
    };
    for (std::size_t k = 0; k < of_loops; ++k)
        if (k % (degree + 1) > 0 && draw.is(0.5)) prior(k, draw.is(0.3) ? 1e-6 : 1.0);
    if (has_temperature && draw.is(0.5)) prior(temperature, 10.0);
    for (std::size_t k = 0; k < meters; ++k) prior(scales + k, draw.is(0.3) ? 1e-6 : 1e-4);
    for (std::size_t station = 0; station < equations.stations; ++station)
        if (station == 0 || draw.is(0.4))
            equations.rows.push_back(
                {gravity_mgal[station], draw.is(0.5) ? 0.001 : 1.0, {{station, 1.0}}, false});
    return equations;
}

test::DenseSolution dense(const Equations& equations, std::size_t left_out = SIZE_MAX) {
    test::Matrix a(equations.stations + equations.terms,
                   std::vector<test::Real>(equations.rows.size()));
    std::vector<test::Real> y(equations.rows.size());
    for (std::size_t i = 0; i < y.size(); ++i) {
        const Equation& row = equations.rows[i];
        if (i == left_out) continue;
        y[i] = static_cast<test::Real>(row.value) / row.sd;
        for (const auto& [unknown, factor] : row.unknowns)
            a[unknown][i] += static_cast<test::Real>(factor) / row.sd;
    }
    return test::solve_dense(std::move(a), y);
}

double relative(test::Real ours, test::Real theirs) {
    return static_cast<double>(std::abs(ours - theirs) / std::max<test::Real>(1, std::abs(theirs)));
}

}  // namespace

TEST_CASE("values, covariance and predictions of random campaigns are those of a dense QR") {
    const std::size_t campaigns = test::is_long() ? 500 : 60;
    std::size_t solved = 0;
    double worst = 0.0, largest_condition = 0.0;
    for (std::uint64_t seed = 1; solved < campaigns; ++seed) {
        const Equations equations = random_problem(seed);
        const Adjustment adjustment(equations);
        REQUIRE(seed < 2000);
        const test::DenseSolution expected = dense(equations);
        if (!adjustment.undetermined().empty()) {
            CHECK(!(expected.condition < 1e6));  // the oracle finds the same dependence
            continue;
        }
        ++solved;
        const auto condition = static_cast<double>(expected.condition);
        largest_condition = std::max(largest_condition, condition);
        const double limit = std::max(1e-9, 100.0 * 2.2e-16 * condition);
        const std::size_t unknowns = equations.stations + equations.terms;
        double error = 0.0;
        for (std::size_t k = 0; k < unknowns; ++k) {
            error = std::max(error, relative(adjustment.value(k), expected.values[k]));
            const test::Real u = std::sqrt(expected.cofactor[k][k]);
            error = std::max(
                error, static_cast<double>(std::abs(std::sqrt(adjustment.cofactor(k, k)) / u - 1)));
            for (std::size_t j = 0; j < k; ++j)
                error = std::max(error,
                                 static_cast<double>(
                                     std::abs(adjustment.cofactor(j, k) - expected.cofactor[j][k]) /
                                     std::sqrt(expected.cofactor[j][j] * expected.cofactor[k][k])));
        }
        // The prediction of some rows without themselves.
        for (std::size_t i = seed % 7; i < equations.rows.size(); i += 17) {
            const double r = adjustment.redundancy(i);
            if (r < 1e-3) continue;
            const auto without = dense(equations, i);
            test::Real predicted = -static_cast<test::Real>(equations.rows[i].value);
            for (const auto& [unknown, factor] : equations.rows[i].unknowns)
                predicted += factor * without.values[unknown];
            error = std::max(error, r * relative(adjustment.residual(i) / r, predicted));
        }
        INFO("seed " << seed << " condition " << condition);
        CHECK(error <= limit);
        worst = std::max(worst, error / limit);
    }
    std::cout << "largest condition " << largest_condition << ", largest error " << worst
              << " of its limit\n";
}

TEST_CASE("unknowns that depend on each other are named, and the others are not") {
    // Station 0 is held.  Station 1 hangs on a loop of its own (term 1), without a tie to station 0.
    Equations equations{3, 3, {}};
    const auto reading = [&](std::size_t station, std::size_t loop) {
        equations.rows.push_back(
            {1.0, 1.0, {{station, 1.0}, {equations.unknown_of_term(loop), 1.0}}, true});
    };
    reading(0, 0);
    reading(2, 0);
    reading(0, 0);
    reading(1, 1);
    reading(1, 1);
    equations.rows.push_back({0.0, 0.01, {{0, 1.0}}, false});
    equations.rows.push_back({0.0, 1.0, {{equations.unknown_of_term(2), 1.0}}, false});
    const Adjustment adjustment(equations);
    CHECK(adjustment.undetermined() == std::vector<std::size_t>{1, equations.unknown_of_term(1)});
    equations.rows.push_back({0.0, 0.01, {{1, 1.0}}, false});
    CHECK(Adjustment(equations).undetermined().empty());
}

TEST_CASE("two readings do not determine three terms, whatever rounding leaves") {
    // From a day that lost half of its stays, with a station left out.  The terms are the constant,
    // the temperature and its rate.
    Equations equations{0, 3, {}};
    for (const auto& [value, temperature, rate] :
         {std::array{1841.3336206222541, -0.21549073789026352, -0.053757961056488973},
          std::array{1843.4090497315096, -0.21563443370779822, 0.099669570257809287}})
        equations.rows.push_back({value, 2.0, {{0, 1.0}, {1, temperature}, {2, rate}}, true});
    CHECK_FALSE(Adjustment(equations).undetermined().empty());
}

TEST_CASE("errors have the scatter of the readings and the stated deviation of a prior") {
    // A line y = b0 + b x with a prior of b.  By hand: var(b) = (Sxx s^2 / r^4 + 1 / p^2) /
    // (Sxx / r^2 + 1 / p^2)^2, with s the true and r the stated deviation of a reading.
    const std::vector<double> x{0.0, 1.0, 2.0, 3.0, 5.0, 8.0};
    constexpr double kStated = 2.0, kPrior = 5.0;
    Equations equations{0, 2, {}};
    double mean = 0.0, sxx = 0.0;
    for (const double one : x) {
        equations.rows.push_back({1.0 + 3.0 * one, kStated, {{0, 1.0}, {1, one}}, true});
        mean += one / 6.0;
    }
    for (const double one : x) sxx += (one - mean) * (one - mean);
    equations.rows.push_back({-30.0, kPrior, {{1, 1.0}}, false});
    const Adjustment adjustment(equations);
    for (const double s : {0.0, 0.7, 2.0, 30.0}) {
        const double weight = sxx / (kStated * kStated) + 1.0 / (kPrior * kPrior);
        const double variance =
            (sxx * s * s / std::pow(kStated, 4) + 1.0 / (kPrior * kPrior)) / (weight * weight);
        CHECK(adjustment.variance({{1, 1.0}}, s / kStated) == Approx(variance));
    }
    // Only the prior determines a slope over one place: its error is that of the prior.
    Equations flat{0, 2, {}};
    for (int i = 0; i < 6; ++i) flat.rows.push_back({3.0, kStated, {{0, 1.0}, {1, 42.5}}, true});
    CHECK(Adjustment(flat).undetermined() == std::vector<std::size_t>{0, 1});
    flat.rows.push_back({-30.0, kPrior, {{1, 1.0}}, false});
    for (const double s : {0.0, 0.1, 30.0})
        CHECK(std::sqrt(Adjustment(flat).variance({{1, 1.0}}, s / kStated)) == Approx(kPrior));
}
