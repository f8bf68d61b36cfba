#include "corrector/whole_day/day_noise.hpp"

#include <algorithm>
#include <numbers>

#include "corrector/whole_day/column_filter.hpp"

namespace a351::corrector::whole_day {
namespace {

using Eigen::Index;
constexpr auto kProcesses = static_cast<Index>(kFlickerPeriods_s.size());

/// Returns the decrease of correlation of the processes over a time, exp(-2 pi dt / period).
Eigen::Array<double, kProcesses, 1> decrease(double lag_s) {
    const Eigen::Map<const Eigen::Array<double, kProcesses, 1>> periods_s(kFlickerPeriods_s.data());
    return (-2.0 * std::numbers::pi * std::abs(lag_s) / periods_s).exp();
}

/// The mean of each process of variance 1 over a bin.
struct BinMean {
    double length_s = 0.0;
    /// Covariance with an instant outside the bin, divided by decrease() over the time from the
    /// bin's middle: sinh(y) / y, y = pi length / period.
    Eigen::Array<double, kProcesses, 1> factor;
    Eigen::Array<double, kProcesses, 1> variance;  ///< (2 y - 1 + exp(-2 y)) / (2 y^2)
};

BinMean mean_over(const reading::DayBin& bin) {
    // The length is that of the samples used.  Bins with missing samples may be longer, but so two
    // bins never overlap.
    double step_s = seconds_between(bin.times.front(), bin.times.back());
    for (std::size_t i = 1; i < bin.times.size(); ++i)
        step_s = std::min(step_s, seconds_between(bin.times[i - 1], bin.times[i]));
    const double length_s = step_s * static_cast<double>(bin.times.size());
    BinMean mean;
    mean.length_s = length_s;
    for (Index k = 0; k < kProcesses; ++k) {
        const double y =
            std::numbers::pi * length_s / kFlickerPeriods_s.at(static_cast<std::size_t>(k));
        mean.factor(k) = y > 0.0 ? std::sinh(y) / y : 1.0;
        mean.variance(k) = y > 0.0 ? (2.0 * y + std::expm1(-2.0 * y)) / (2.0 * y * y) : 1.0;
    }
    return mean;
}

/// Returns the mean of the error after a turn over a bin, divided by its value in the middle.
double turn_factor(const BinMean& mean) {
    const double y = 0.5 * mean.length_s / kTurn_s;
    return y > 0.0 ? std::sinh(y) / y : 1.0;
}

/// Returns the variance of the white noise of a bin.
double white_variance(const DayNoise& noise, double samples) {
    return noise.white_mgal * noise.white_mgal * static_cast<double>(reading::kBinSamples) /
           samples;
}

}  // namespace

double whiten(const std::vector<reading::DayBin>& bins, const DayNoise& noise,
              Eigen::MatrixXd& columns) {
    return Whitening(bins).whiten(noise, columns);
}

Whitening::Whitening(const std::vector<reading::DayBin>& bins)
    : has_two_faces_(reading::has_two_faces(bins)) {
    double end_s = 0.0;  // from the middle of the bin before to its end
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const BinMean mean = mean_over(bins[i]);
        const double since_s = i == 0 ? 0.0 : seconds_between(bins[i - 1].time, bins[i].time);
        bins_.push_back({i == 0 || bins[i].set_up != bins[i - 1].set_up, decrease(since_s),
                         mean.factor, (mean.variance - mean.factor.square()).sum(),
                         static_cast<double>(bins[i].times.size()), bins[i].face});
        Bin& bin = bins_.back();
        bin.turn_keep = std::exp(-since_s / kTurn_s);
        bin.turn_factor = turn_factor(mean);
        if (i > 0 && bins[i].face != bins[i - 1].face)
            bin.turn_variance = std::pow(kTurn_mgal * std::exp((end_s - since_s) / kTurn_s), 2);
        end_s = 0.5 * mean.length_s;
    }
}

double Whitening::whiten(const DayNoise& noise, Eigen::MatrixXd& columns) const {
    return has_two_faces_ ? whiten_states<true>(noise, columns)
                          : whiten_states<false>(noise, columns);
}

template <bool kTwoFaces>
double Whitening::whiten_states(const DayNoise& noise, Eigen::MatrixXd& columns) const {
    // Flicker, placement, then in two faces the flicker of the scale and the error after a turn.
    constexpr Index kStates = kTwoFaces ? 2 * kProcesses + 2 : kProcesses + 1;
    constexpr Index kOnScale = kProcesses + 1, kTurn = kStates - 1;
    using State = Eigen::Matrix<double, kStates, 1>;
    const double flicker_part =
        noise.flicker_mgal * noise.flicker_mgal / static_cast<double>(kProcesses);
    const double placement = noise.placement_mgal * noise.placement_mgal;

    State variances = State::Constant(flicker_part);
    if constexpr (kTwoFaces) {
        variances.template head<kProcesses>() *= 1.0 - noise.flicker_on_scale;
        variances.template segment<kProcesses>(kOnScale) *= noise.flicker_on_scale;
        variances(kTurn) = 0.0;
    }
    const FilterBin<kStates> filter = fastest_filter<kStates>();
    FilteredColumns<kStates> filtered(columns);
    FilterStep<kStates> step;
    step.covariance = variances.asDiagonal();
    double log_determinant = 0.0;
    for (Index row = 0; row < std::ssize(bins_); ++row) {
        const Bin& bin = bins_[static_cast<std::size_t>(row)];
        // Prediction: x = K x, P = K P K + Q.  A new set-up has a new placement.
        step.keep.template head<kProcesses>() = bin.keep;
        step.keep(kProcesses) = bin.is_new_set_up ? 0.0 : 1.0;
        if constexpr (kTwoFaces) {
            step.keep.template segment<kProcesses>(kOnScale) = bin.keep;
            step.keep(kTurn) = bin.turn_keep;
        }
        step.added = variances.array() * (1.0 - step.keep.array().square());
        step.added(kProcesses) = bin.is_new_set_up ? placement : 0.0;
        if constexpr (kTwoFaces) step.added(kTurn) = bin.turn_variance;

        // Measurement: h times the states, and noise.  A mean varies less than h^2, so the noise may
        // have a negative variance; that of the reading is positive.
        step.measured.template head<kProcesses>() = bin.factor;
        step.measured(kProcesses) = 1.0;
        if constexpr (kTwoFaces) {
            step.measured.template segment<kProcesses>(kOnScale) = bin.face * bin.factor;
            step.measured(kTurn) = bin.turn_factor;
        }
        step.of_mean = flicker_part * bin.within;
        step.white = white_variance(noise, bin.samples);
        filter(step, row, filtered);
        log_determinant += std::log(step.variance);
    }
    // Innovations divided by their standard deviation are white.
    columns = filtered.values.topRows(columns.cols()).transpose();
    return log_determinant;
}

NoiseCovariance::NoiseCovariance(const std::vector<reading::DayBin>& bins)
    : bins_(bins), flicker_(std::ssize(bins), std::ssize(bins)), turns_(std::ssize(bins), 0) {
    std::vector<BinMean> means;
    for (const reading::DayBin& bin : bins) means.push_back(mean_over(bin));
    for (std::size_t i = 0; i < bins.size(); ++i)
        for (std::size_t k = 0; k <= i; ++k)
            flicker_(static_cast<Index>(i), static_cast<Index>(k)) =
                i == k ? means[i].variance.sum()
                       : (means[i].factor * means[k].factor *
                          decrease(seconds_between(bins[k].time, bins[i].time)))
                             .sum();
    for (std::size_t at = 1; at < bins.size(); ++at) {
        if (bins[at].face == bins[at - 1].face) continue;
        const UtcTime time = bins[at - 1].time + from_seconds(0.5 * means[at - 1].length_s);
        turns_.conservativeResize(Eigen::NoChange, turns_.cols() + 1);
        auto turn = turns_.rightCols<1>();
        turn.setZero();
        for (std::size_t i = at; i < bins.size(); ++i)
            turn(static_cast<Index>(i)) = kTurn_mgal * turn_factor(means[i]) *
                                          std::exp(-seconds_between(time, bins[i].time) / kTurn_s);
    }
}

Eigen::MatrixXd NoiseCovariance::at(const DayNoise& noise) const {
    const double flicker_part =
        noise.flicker_mgal * noise.flicker_mgal / static_cast<double>(kProcesses);
    Eigen::MatrixXd covariance(flicker_.rows(), flicker_.cols());
    for (Index i = 0; i < covariance.rows(); ++i)
        for (Index k = 0; k <= i; ++k) {
            const reading::DayBin& a = bins_[static_cast<std::size_t>(i)];
            const reading::DayBin& b = bins_[static_cast<std::size_t>(k)];
            double sum = flicker_part * flicker_(i, k);
            if (i == k) sum += white_variance(noise, static_cast<double>(a.times.size()));
            if (a.face != b.face) sum *= 1.0 - 2.0 * noise.flicker_on_scale;
            for (Index turn = 0; turn < turns_.cols(); ++turn)
                sum += turns_(i, turn) * turns_(k, turn);
            if (a.set_up == b.set_up) sum += std::pow(noise.placement_mgal, 2);
            covariance(i, k) = covariance(k, i) = sum;
        }
    return covariance;
}

}  // namespace a351::corrector::whole_day
