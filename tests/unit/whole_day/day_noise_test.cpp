#include "corrector/whole_day/day_noise.hpp"
#include "corrector/whole_day/column_filter.hpp"

#include <Eigen/Cholesky>
#include <utility>

#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

TEST_CASE("the filter whitens like the dense covariance") {
    const double on_scale = GENERATE(0.0, 0.3, 1.0);
    const bool has_two_faces = GENERATE(false, true);
    std::vector<DayBin> bins = MadeUpDay{.has_two_faces = has_two_faces}.record().bins;
    for (std::size_t i = 0; i < bins.size(); i += 3) {
        bins[i].times.resize(9);
        bins[i].time = bins[i].times[4];
    }
    const DayNoise noise{1.1, 0.8, 0.3, on_scale};
    const Eigen::MatrixXd columns =
        Eigen::MatrixXd::Random(static_cast<Eigen::Index>(bins.size()), 4);
    Eigen::MatrixXd white = columns;
    const double log_determinant = whiten(bins, noise, white);

    const Eigen::LLT<Eigen::MatrixXd> dense(NoiseCovariance(bins).at(noise));
    const Eigen::MatrixXd expected = columns.transpose() * dense.solve(columns);
    CHECK((white.transpose() * white - expected).norm() < 1e-9 * expected.norm());
    CHECK(log_determinant ==
          Approx(2.0 * dense.matrixLLT().diagonal().array().log().sum()).epsilon(1e-12));
}

TEMPLATE_TEST_CASE_SIG("the filter has the same bits with any number of lanes", "[day]",
                       ((Eigen::Index kStates), kStates), 8, 16) {
    if (fastest_filter<kStates>() == FilterBin<kStates>(with_two_lanes<kStates>)) {
        WARN("this processor has one form of the filter");
        return;
    }
    Eigen::MatrixXd columns = Eigen::MatrixXd::Random(20, 6);
    columns.topRightCorner(10, 2).setZero();
    const auto filtered = [&columns](FilterBin<kStates> filter) {
        FilteredColumns<kStates> result(columns);
        FilterStep<kStates> step;
        step.covariance.setIdentity();
        step.of_mean = -0.1;
        step.white = 0.3;
        for (Eigen::Index row = 0; row < columns.rows(); ++row) {
            step.keep.setLinSpaced(0.1, 0.99);
            step.added = 1.0 - step.keep.array().square();
            step.measured.setConstant(1.0 + 0.01 * static_cast<double>(row));
            filter(step, row, result);
        }
        return result.values;
    };
    CHECK(filtered(fastest_filter<kStates>()) == filtered(with_two_lanes<kStates>));
}

TEST_CASE("means of simulated flicker have the covariance of the bins") {
    // Two bins that follow each other, the second of a third of the length, and one 500 s later.
    constexpr std::array<int, 3> kFirst{0, 25, 275}, kSamples{25, 8, 25};
    std::vector<DayBin> bins(3);
    for (std::size_t b = 0; b < bins.size(); ++b) {
        bins[b].set_up = b;
        for (int i = 0; i < kSamples.at(b); ++i)
            bins[b].times.push_back(UtcTime{} + from_seconds(2.0 * (kFirst.at(b) + i)));
        bins[b].time = UtcTime{} + from_seconds(2.0 * kFirst.at(b) + kSamples.at(b) - 1.0);
    }
    const Eigen::MatrixXd expected = NoiseCovariance(bins).at({0.0, 1.0, 0.0});

    // The processes are stepped by 0.25 s in a bin, and at once over the time between two bins.
    constexpr double kStep_s = 0.25;
    constexpr int kDays = 4000;
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int day = 0; day < kDays; ++day) {
        Eigen::Vector3d means = Eigen::Vector3d::Zero();
        for (const double period_s : kFlickerPeriods_s) {
            double value = normal(random);
            const auto advance = [&](int steps) {
                const double keep = std::exp(-2.0 * std::numbers::pi * steps * kStep_s / period_s);
                value = keep * value + std::sqrt(1.0 - keep * keep) * normal(random);
            };
            int last = 0;
            for (std::size_t b = 0; b < 3; ++b) {
                for (int i = 8 * kFirst.at(b); i < 8 * (kFirst.at(b) + kSamples.at(b)); ++i) {
                    advance(i - std::exchange(last, i));
                    means(static_cast<Eigen::Index>(b)) +=
                        value / std::sqrt(7.0) / (8.0 * kSamples.at(b));
                }
            }
        }
        sum += means * means.transpose() / kDays;
    }
    INFO("simulated\n" << sum << "\nexpected\n" << expected);
    CHECK((sum - expected).cwiseAbs().maxCoeff() < 0.06);  // three standard errors
    CHECK(expected(0, 0) < 0.8);                           // a point sample would have 1
}

TEST_CASE(
    "flicker of the scale keeps its sign over a turn, and a turn leaves an error that decays") {
    std::vector<DayBin> bins(3);
    for (std::size_t b = 0; b < bins.size(); ++b) {
        bins[b].set_up = b;
        bins[b].face = b == 0 ? 1.0 : -1.0;
        bins[b].time = UtcTime{} + from_seconds(120.0 * static_cast<double>(b));
        bins[b].times = {bins[b].time};
    }
    const auto covariance = [&](double flicker_mgal, double on_scale) {
        return NoiseCovariance(bins).at({0.0, flicker_mgal, 1.0, on_scale});
    };
    // A bin of one sample has no length.  Rows have the sign of the face.
    const Eigen::MatrixXd turn = covariance(0.0, 0.0);
    const double keep = std::exp(-120.0 / kTurn_s);
    CHECK(turn(0, 1) == 0.0);
    CHECK(turn(1, 2) == Approx(std::pow(kTurn_mgal * keep, 2) * keep));
    const Eigen::MatrixXd of_bias = covariance(1.0, 0.0) - turn,
                          of_scale = covariance(1.0, 1.0) - turn,
                          half = covariance(1.0, 0.5) - turn;
    CHECK(of_bias(0, 1) > 0.3);
    CHECK(of_scale(0, 1) == Approx(-of_bias(0, 1)));
    CHECK(of_scale(1, 2) == Approx(of_bias(1, 2)));
    CHECK(half(0, 1) == Approx(0.0).margin(1e-12));
}

TEST_CASE("flicker is 1/f between its first and last period") {
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
