#include "protocol/signal/distributions.hpp"

#include <cmath>
#include <stdexcept>
#include "tests/support/catch.hpp"

using namespace a351::signal;

TEST_CASE("quantiles are those of printed tables") {
    // M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 1964, tables 26.10 and 26.8,
    // to three decimals: the tolerance is half a unit of the last one.
    const auto printed = [](double value) { return Approx(value).epsilon(0.0).margin(0.0005); };
    CHECK(students_t_quantile(1.0, 0.975) == printed(12.706));
    CHECK(students_t_quantile(10.0, 0.975) == printed(2.228));
    CHECK(students_t_quantile(30.0, 0.995) == printed(2.750));
    CHECK(chi_square_quantile(1.0, 0.95) == printed(3.841));
    CHECK(chi_square_quantile(10.0, 0.025) == printed(3.247));
    CHECK(chi_square_upper_quantile(10.0, 0.025) == printed(20.483));
}

TEST_CASE("with one and two degrees of freedom the distributions have closed forms") {
    for (const double p : {0.6, 0.9, 0.999}) {
        CHECK(students_t_quantile(1.0, p) == Approx(std::tan(M_PI * (p - 0.5))).epsilon(1e-12));
        CHECK(chi_square_quantile(2.0, p) == Approx(-2.0 * std::log(1.0 - p)).epsilon(1e-12));
        CHECK(chi_square_exceedance(2.0, 3.0 * p) == Approx(std::exp(-1.5 * p)).epsilon(1e-12));
    }
}

TEST_CASE("both tails agree, and a small probability is not lost") {
    for (const double dof : {1.5, 4.0, 60.0}) {
        CHECK(students_t_exceedance(dof, students_t_quantile(dof, 0.9)) ==
              Approx(0.1).epsilon(1e-12));
        CHECK(chi_square_upper_quantile(dof, 0.1) ==
              Approx(chi_square_quantile(dof, 0.9)).epsilon(1e-12));
        const double far = chi_square_upper_quantile(dof, 1e-30);
        CHECK(chi_square_exceedance(dof, far) == Approx(1e-30).epsilon(1e-9));
    }
}

TEST_CASE("no degrees of freedom, or no probability, is refused") {
    CHECK_THROWS_AS(students_t_quantile(0.0, 0.5), std::domain_error);
    CHECK_THROWS_AS(students_t_exceedance(-1.0, 0.5), std::domain_error);
    CHECK_THROWS_AS(chi_square_quantile(2.0, 1.5), std::domain_error);
    CHECK_THROWS_AS(chi_square_exceedance(2.0, -1.0), std::domain_error);
}
