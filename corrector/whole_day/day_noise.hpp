#pragma once
/// @file
/// The noise of a survey day, and how correlated readings are turned into independent ones.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "corrector/reading/day_record.hpp"

namespace a351::corrector {

/// Three independent parts, as standard deviations in mGal.
struct DayNoise {
    double placement_mgal = 0.0;  ///< One value for every set-up.
    double flicker_mgal = 0.0;    ///< 1/f over the day.
    double white_mgal = 0.0;      ///< Of a complete bin.
};

/// Flicker as a sum of equally strong first-order (Ornstein-Uhlenbeck) processes with corner
/// periods in steps of sqrt(10), from a bin to half a day: within 5 % of 1/f between them.
inline constexpr std::array<double, 7> kFlickerPeriods_s{40.0,   126.5,   400.0,  1265.0,
                                                         4000.0, 12649.0, 40000.0};

/// Multiplies by a root of the inverse covariance of the noise: rows that belong to the bins come out
/// independent and of variance 1.  A Kalman filter in O(bins x columns); against the dense
/// factorisation: day_noise_test.cpp, 1e-9.
/// @param columns  (n, c), in place.
/// @return the logarithm of the covariance's determinant.
/// Source: A. C. Harvey, Forecasting, Structural Time Series Models and the Kalman Filter, Cambridge
/// 1989, section 3.4 (regression by filtering every column).
double whiten(const std::vector<DayBin>& bins, const DayNoise& noise, Eigen::MatrixXd& columns);

}  // namespace a351::corrector
