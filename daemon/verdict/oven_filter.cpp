#include "daemon/verdict/oven_filter.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/units.hpp"

namespace a351::daemon::verdict {
namespace {

// Values that gave the most likely outlook of 10 min on simulated warm-ups, visits and disturbances:
// seeds 1 to 50 and 251 to 350 of tests/bench/verdict_bench.cpp, which is in the history up to b747d9bc.
constexpr double kRateSeconds = 700.0;    ///< Decay time of a change of the ambient temperature.
constexpr double kCycleSeconds = 2500.0;  ///< Decay time of the oven's cycle.
constexpr double kLevelNoise = 5e-4;      ///< [degC / s^(1/2)]
constexpr double kRateNoise = 4e-7;       ///< [degC / s^(3/2)]
constexpr double kCycleNoise = 9.4e-5;    ///< [degC / s^(1/2)]

// Initial standard errors.
constexpr double kBodyDegc = 0.1, kLevelDegc = 0.2, kRateDegcPerSecond = 1e-4, kCycleDegc = 0.01;

double square(double x) { return x * x; }

constexpr int kN = static_cast<int>(OvenFilter::kStates);
using Vector = Eigen::Matrix<double, kN, 1>;
using Matrix = Eigen::Matrix<double, kN, kN>;
using ToVector = Eigen::Map<Vector>;
using ToMatrix = Eigen::Map<Matrix>;
using AsVector = Eigen::Map<const Vector>;
using AsMatrix = Eigen::Map<const Matrix>;

}  // namespace

OvenFilter::OvenFilter(const Options& options)
    : lid_degc_(options.lid_degc), lid_degc_per_s_(options.lid_degc_per_h / kSecondsPerHour) {
    constexpr double h = kStepSeconds;
    const double relax_s = 60.0 * options.relax_min;
    Eigen::Matrix3d rates;
    rates << -1.0 / relax_s, 1.0 / relax_s, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0 / kRateSeconds;
    // The exponential of the matrix; a few terms suffice because steps are short.
    Eigen::Matrix3d term = Eigen::Matrix3d::Identity(), chain = term;
    for (int k = 1; k < 8; ++k) {
        term = (term * rates * h / k).eval();
        chain += term;
    }
    const double turn = 2.0 * std::numbers::pi * h / options.cycle_s;
    const double keep = std::exp(-h / kCycleSeconds);
    ToMatrix transition(transition_.data()), unrest(unrest_.data());
    transition.topLeftCorner<3, 3>() = chain;
    transition.bottomRightCorner<2, 2>() << keep * std::cos(turn), keep * std::sin(turn),
        -keep * std::sin(turn), keep * std::cos(turn);
    unrest(1, 1) = square(kLevelNoise) * h + square(kRateNoise) * h * h * h / 3.0;
    unrest(1, 2) = unrest(2, 1) = square(kRateNoise) * h * h / 2.0;
    unrest(2, 2) = square(kRateNoise) * h;
    unrest(3, 3) = unrest(4, 4) = square(kCycleNoise) * h;
    begin(options.operating_degc);
}

void OvenFilter::begin(double degc) {
    state_ = {degc, degc, 0.0, 0.0, 0.0};
    ToMatrix covariance(covariance_.data());
    covariance.setZero();
    covariance.diagonal() << square(kBodyDegc), square(kLevelDegc), square(kRateDegcPerSecond),
        square(kCycleDegc), square(kCycleDegc);
}

OvenFilter::State OvenFilter::ahead(const State& state) const {
    State later;
    ToVector(later.data()) = AsMatrix(transition_.data()) * AsVector(state.data());
    return later;
}

double OvenFilter::variance_of(const State& weights) const {
    const AsVector w(weights.data());
    return w.dot(AsMatrix(covariance_.data()) * w);
}

void OvenFilter::step() {
    state_ = ahead(state_);
    const AsMatrix transition(transition_.data());
    ToMatrix covariance(covariance_.data());
    covariance = (transition * covariance * transition.transpose()).eval();
    covariance += AsMatrix(unrest_.data());
}

void OvenFilter::see(double degc, double rms_degc) {
    ToMatrix covariance(covariance_.data());
    const Vector column = covariance.col(0) + covariance.col(3);
    const double variance = column[0] + column[3] + square(rms_degc);
    ToVector(state_.data()) += column * ((degc - seen(state_)) / variance);
    covariance -= column * column.transpose() / variance;
}

void OvenFilter::touch() {
    ToMatrix covariance(covariance_.data());
    covariance(1, 1) = std::max(covariance(1, 1), square(lid_degc_));
    covariance(2, 2) = std::max(covariance(2, 2), square(lid_degc_per_s_));
}

}  // namespace a351::daemon::verdict
