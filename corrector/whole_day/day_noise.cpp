#include "corrector/whole_day/day_noise.hpp"

#include <cmath>
#include <numbers>

namespace a351::corrector::whole_day {

double whiten(const std::vector<reading::DayBin>& bins, const DayNoise& noise,
              Eigen::MatrixXd& columns) {
    constexpr auto kFlicker = static_cast<Eigen::Index>(kFlickerPeriods_s.size());
    constexpr Eigen::Index kStates = kFlicker + 1;  // the last state is placement
    using State = Eigen::Matrix<double, kStates, 1>;
    const double flicker_part =
        noise.flicker_mgal * noise.flicker_mgal / static_cast<double>(kFlicker);
    const double placement = noise.placement_mgal * noise.placement_mgal;

    Eigen::Matrix<double, kStates, kStates> covariance =
        Eigen::Matrix<double, kStates, kStates>::Zero();
    covariance.diagonal().setConstant(flicker_part);
    Eigen::MatrixXd state = Eigen::MatrixXd::Zero(kStates, columns.cols());
    double log_determinant = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        State keep = State::Ones();
        if (i > 0) {
            const double lag_s = seconds_between(bins[i - 1].time, bins[i].time);
            for (Eigen::Index k = 0; k < kFlicker; ++k)
                keep(k) = std::exp(-2.0 * std::numbers::pi * std::abs(lag_s) /
                                   kFlickerPeriods_s.at(static_cast<std::size_t>(k)));
        }
        if (i == 0 || bins[i].set_up != bins[i - 1].set_up) keep(kFlicker) = 0.0;
        // Prediction: x = K x, P = K P K + Q.  A new set-up has a new placement.
        state = keep.asDiagonal() * state;
        covariance = keep.asDiagonal() * covariance * keep.asDiagonal();
        for (Eigen::Index k = 0; k < kFlicker; ++k)
            covariance(k, k) += flicker_part * (1.0 - keep(k) * keep(k));
        if (keep(kFlicker) == 0.0) covariance(kFlicker, kFlicker) = placement;

        // Measurement: the reading is the sum of all states and white noise.
        const State gain = covariance.rowwise().sum();
        const double white = noise.white_mgal * noise.white_mgal *
                             static_cast<double>(reading::kBinSamples) /
                             static_cast<double>(bins[i].times.size());
        const double variance = gain.sum() + white;
        const auto row = static_cast<Eigen::Index>(i);
        const Eigen::RowVectorXd innovation = columns.row(row) - state.colwise().sum();
        state += gain / variance * innovation;
        covariance -= gain * gain.transpose() / variance;
        // Innovations divided by their standard deviation are white.
        columns.row(row) = innovation / std::sqrt(variance);
        log_determinant += std::log(variance);
    }
    return log_determinant;
}

Eigen::MatrixXd noise_covariance(const std::vector<reading::DayBin>& bins, const DayNoise& noise) {
    Eigen::MatrixXd covariance(std::ssize(bins), std::ssize(bins));
    for (std::size_t i = 0; i < bins.size(); ++i)
        for (std::size_t k = 0; k <= i; ++k) {
            double correlation = 0.0;
            for (const double period_s : kFlickerPeriods_s)
                correlation +=
                    std::exp(-2.0 * std::numbers::pi *
                             std::abs(seconds_between(bins[k].time, bins[i].time)) / period_s) /
                    static_cast<double>(kFlickerPeriods_s.size());
            double sum = std::pow(noise.flicker_mgal, 2) * correlation;
            if (bins[i].set_up == bins[k].set_up) sum += std::pow(noise.placement_mgal, 2);
            if (i == k)
                sum += std::pow(noise.white_mgal, 2) * static_cast<double>(reading::kBinSamples) /
                       static_cast<double>(bins[i].times.size());
            covariance(static_cast<Index>(i), static_cast<Index>(k)) = sum;
            covariance(static_cast<Index>(k), static_cast<Index>(i)) = sum;
        }
    return covariance;
}

}  // namespace a351::corrector::whole_day
