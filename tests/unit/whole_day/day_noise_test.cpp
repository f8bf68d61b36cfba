#include "corrector/whole_day/day_noise.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include "tests/support/catch.hpp"

#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

namespace {

/// Returns the covariance of flicker of unit variance at two times `lag_s` apart.
double flicker_correlation(double lag_s) {
    double sum = 0.0;
    for (const double period_s : kFlickerPeriods_s)
        sum += std::exp(-2.0 * std::numbers::pi * std::abs(lag_s) / period_s);
    return sum / static_cast<double>(kFlickerPeriods_s.size());
}

/// Returns the covariance of the bins from the definition of the noise.
Eigen::MatrixXd covariance(const std::vector<DayBin>& bins, const DayNoise& noise) {
    const auto n = static_cast<Eigen::Index>(bins.size());
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const DayBin& a = bins[static_cast<std::size_t>(i)];
        for (Eigen::Index j = 0; j < n; ++j) {
            const DayBin& b = bins[static_cast<std::size_t>(j)];
            matrix(i, j) = noise.flicker_mgal * noise.flicker_mgal *
                           flicker_correlation(seconds_between(a.time, b.time));
            if (a.set_up == b.set_up) matrix(i, j) += std::pow(noise.placement_mgal, 2);
            if (i == j)
                matrix(i, j) += std::pow(noise.white_mgal, 2) * static_cast<double>(kBinSamples) /
                                static_cast<double>(a.times.size());
        }
    }
    return matrix;
}

}  // namespace

TEST_CASE("the filter whitens like the dense covariance", "[day]") {
    std::vector<DayBin> bins = MadeUpDay{}.record().bins;
    for (std::size_t i = 0; i < bins.size(); i += 3) bins[i].times.resize(9);
    const DayNoise noise{1.1, 0.8, 0.3};
    const Eigen::MatrixXd columns =
        Eigen::MatrixXd::Random(static_cast<Eigen::Index>(bins.size()), 4);
    Eigen::MatrixXd white = columns;
    const double log_determinant = whiten(bins, noise, white);

    const Eigen::LLT<Eigen::MatrixXd> dense(covariance(bins, noise));
    const Eigen::MatrixXd expected = columns.transpose() * dense.solve(columns);
    CHECK((white.transpose() * white - expected).norm() < 1e-9 * expected.norm());
    CHECK(log_determinant ==
          Approx(2.0 * dense.matrixLLT().diagonal().array().log().sum()).epsilon(1e-12));
}

TEST_CASE("flicker is 1/f between its first and last period", "[day]") {
    // Returns the spectrum of the sum of processes with these corners, times frequency.
    const auto power = [](double period_s) {
        double sum = 0.0;
        for (const double corner_s : kFlickerPeriods_s) {
            const double ratio = corner_s / period_s;
            sum += corner_s / (1.0 + ratio * ratio);
        }
        return sum / period_s;
    };
    double least = 1e9, largest = 0.0;
    for (double period_s = 120.0; period_s < 13000.0; period_s *= 1.1) {
        least = std::min(least, power(period_s));
        largest = std::max(largest, power(period_s));
    }
    INFO("from " << least << " to " << largest);
    CHECK(largest < 1.11 * least);  // 5 % to either side
}
