#include "corrector/whole_day/day_noise.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include "tests/support/catch.hpp"

#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

TEST_CASE("the filter whitens like the dense covariance", "[day]") {
    std::vector<DayBin> bins = MadeUpDay{}.record().bins;
    for (std::size_t i = 0; i < bins.size(); i += 3) bins[i].times.resize(9);
    const DayNoise noise{1.1, 0.8, 0.3};
    const Eigen::MatrixXd columns =
        Eigen::MatrixXd::Random(static_cast<Eigen::Index>(bins.size()), 4);
    Eigen::MatrixXd white = columns;
    const double log_determinant = whiten(bins, noise, white);

    const Eigen::LLT<Eigen::MatrixXd> dense(noise_covariance(bins, noise));
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
