#include "protocol/unit/thermal_response.hpp"

#include <cmath>
#include <numbers>
#include <tuple>
#include "tests/support/catch.hpp"

#include "protocol/core/utc_time.hpp"

using namespace a351;
using namespace a351::unit;

namespace {

const UtcTime kStart = *parse_rfc3339("2026-05-01T00:00:00Z");

}  // namespace

TEST_CASE("a ramp after a first-order lag agrees with the exact solution") {
    std::vector<double> ramp(2000);
    for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 40.0 + 0.001 * static_cast<double>(i);
    const double tau_s = 43.0;
    const auto y = lagged({kStart, Hertz(0.5), ramp}, tau_s);
    CHECK(y.front() == ramp.front());
    for (const std::size_t i : {std::size_t{1}, std::size_t{20}, std::size_t{1999}}) {
        const double t_s = 2.0 * static_cast<double>(i);
        const double exact = 40.0 + 0.0005 * (t_s - tau_s * (1.0 - std::exp(-t_s / tau_s)));
        CHECK(y[i] == Approx(exact).epsilon(1e-13));
    }
}

TEST_CASE("a sine of twelve samples has its exact response to a lag") {
    const double step_s = 20.0, period_s = 240.0,
                 tau_s = GENERATE(0.01, 0.5, 4.9, 5.1, 43.0, 2700.0);
    CAPTURE(tau_s);
    constexpr std::size_t kPeriod = 12, kSettled = 500 * kPeriod;
    const double w = 2.0 * std::numbers::pi / period_s;
    std::vector<double> degc(kSettled + 2 * kPeriod);
    for (std::size_t i = 0; i < degc.size(); ++i)
        degc[i] = std::sin(w * step_s * static_cast<double>(i));
    const auto y = lagged({kStart, Hertz(1.0 / step_s), degc}, tau_s);
    const auto response = 1.0 / std::complex<double>(1.0, w * tau_s);
    for (std::size_t i = kSettled; i < kSettled + kPeriod; ++i) {
        const auto turned = response * std::polar(1.0, w * step_s * static_cast<double>(i));
        CHECK(std::abs(y[i] - turned.imag()) < 0.002 * std::abs(response));
    }
}

TEST_CASE("the effect of a sine has the amplitude and phase of the complex response") {
    const ThermalEffect effect{-12.0, -20.0, 11.3, 43.0, 2700.0};
    const double step_s = 2.0, period_s = GENERATE(300.0, 900.0, 7200.0);
    CAPTURE(period_s);
    const auto whole = static_cast<std::size_t>(period_s / step_s);
    const std::size_t settled = static_cast<std::size_t>(40000.0 / step_s) / whole * whole;
    std::vector<double> degc(settled + whole);
    const auto turn = [&](std::size_t i) {
        return 2.0 * std::numbers::pi * static_cast<double>(i) * step_s / period_s;
    };
    for (std::size_t i = 0; i < degc.size(); ++i) degc[i] = 42.5 + 0.05 * std::sin(turn(i));
    const auto mgal = effect.of({kStart, Hertz(1.0 / step_s), degc}, 42.5);
    std::complex<double> found;
    for (std::size_t i = settled; i < degc.size(); ++i)
        found += mgal[i] * std::polar(2.0 / static_cast<double>(whole), -turn(i));
    // sin = (e^(iwt) - e^(-iwt)) / 2i
    const auto response = found * std::complex<double>(0.0, 1.0) / 0.05;
    const auto expected = effect.at(period_s);
    CHECK(std::abs(response - expected) < 1e-5 * std::abs(expected));
}

TEST_CASE("priors of a day are the typical unit, those of a record leave it open") {
    for (const auto& [term, mean, deviation] :
         {std::tuple{ThermalTerm::level, -12.0, 7.2},
          {ThermalTerm::slow, -20.0, 12.0},
          {ThermalTerm::fast, 11.3, 6.78},
          {ThermalTerm::fast_lag, std::log(43.0), std::log(1.5)},
          {ThermalTerm::slow_lag, std::log(2700.0), std::log(1.5)}}) {
        CAPTURE(static_cast<int>(term));
        CHECK(day_prior(term).mean == mean);
        CHECK(day_prior(term).deviation == Approx(deviation));
        CHECK(record_prior(term).deviation > day_prior(term).deviation);
    }
    CHECK(record_prior(ThermalTerm::fast_lag).mean == day_prior(ThermalTerm::fast_lag).mean);
}
