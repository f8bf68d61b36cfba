#include "corrector/long_record/two_path_regression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "corrector/long_record/two_path_fit.hpp"
#include "corrector/whole_day/day_priors.hpp"
#include "corrector/whole_day/least_cost.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"
#include "protocol/signal/fourier.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/signal/regression.hpp"

namespace a351::corrector::long_record {
namespace {

using Index = Eigen::Index;
using Lags = TwoPathLags;

constexpr double kShortest_s = 240.0;  // at shorter periods the thermometer's noise dominates
constexpr Index kLinear = kTwoPathLinear;

double lag_s(const Lags& u, std::size_t k) { return kTwoPathLags_s.at(k).at(u.at(k)); }

}  // namespace

TwoPathRegression::TwoPathRegression(const std::vector<double>& temperature,
                                     const std::vector<double>& acceleration, double step_s,
                                     const std::vector<double>& outer)
    : count_(fast_length_within(temperature.size())),
      step_s_(step_s),
      temperature_(
          {}, Hertz(1.0 / step_s),
          {temperature.begin(), temperature.begin() + static_cast<std::ptrdiff_t>(count_)}) {
    if (!outer.empty()) outer_.emplace(UtcTime{}, Hertz(1.0 / step_s), outer);
    frequencies_ = std::min(static_cast<Index>(static_cast<double>(count_) * step_s / kShortest_s),
                            static_cast<Index>(count_ / 2));
    readings_ = transformed(
        {acceleration.begin(), acceleration.begin() + static_cast<std::ptrdiff_t>(count_)});
    mean_degc_ = signal::mean_of(temperature_.values());
    numbers_.resize(count_);
    std::iota(numbers_.begin(), numbers_.end(), 0.0);
    ramp_ = transformed(numbers_);
    set_trust(acceleration);
    noise_ = Eigen::VectorXd::Ones(frequencies_);
    for (Index k = 0; k < frequencies_; ++k) noise_(k) = 1.0 / static_cast<double>(k + 1);
}

std::vector<std::vector<double>> TwoPathRegression::columns(const TimeSeries<DegC>& temperature,
                                                            const Lags& u) const {
    const std::vector<double>& t = temperature.values();
    std::vector<std::vector<double>> all(kLinear, std::vector<double>(t.size()));
    all[3] = unit::fast_rate_degc_per_h(temperature, lag_s(u, 0));
    all[4] = unit::lagged(temperature, lag_s(u, 1));
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double time_h = static_cast<double>(i) * step_s_ / kSecondsPerHour;
        all[0][i] = time_h;
        all[1][i] = std::exp(-time_h * kSecondsPerHour / lag_s(u, 2));
        all[2][i] = t[i] - mean_degc_;
        all[4][i] -= mean_degc_;
    }
    if (outer_)
        for (const std::vector<double>& outer :
             {outer_->values(), unit::lagged(*outer_, lag_s(u, 3))})
            all.emplace_back(outer.begin(), outer.begin() + std::ssize(t));
    return all;
}

Eigen::MatrixXd TwoPathRegression::design(const Lags& u) const {
    const auto all = columns(temperature_, u);
    Eigen::MatrixXd x(2 * frequencies_, linear());
    for (Index k = 0; k < linear(); ++k) {
        const auto place = static_cast<std::size_t>(k);
        Eigen::VectorXd column = transformed(all[place]);
        if (place >= static_cast<std::size_t>(TwoPathTerm::level) && k < kLinear)
            column = trusted(std::move(column), signal::fit_line(numbers_, all[place]).slope);
        x.col(k) = kTwoPathDeviations.at(place) * whitened(std::move(column));
    }
    return x;
}

double TwoPathRegression::cost(const Lags& u) const {
    double sum = linear_algebra::marginal_cost(design(u), readings());
    for (const double value : u) sum += value * value;
    return 0.5 * sum;
}

TwoPathLags TwoPathRegression::most_likely(const Lags& start, bool is_nearby) const {
    const auto lags_of = [](const std::vector<double>& searched) {
        Lags u{};
        std::ranges::copy(searched, u.begin());
        return u;
    };
    return lags_of(whole_day::least_cost_point(
        [&](const std::vector<double>& u) { return cost(lags_of(u)); },
        {start.begin(), start.begin() + static_cast<std::ptrdiff_t>(lag_count())}, is_nearby,
        {.farthest = 5.0, .first_step = 0.3, .tolerance = 0.01, .most_costs = 120}));
}

Eigen::VectorXd TwoPathRegression::coefficients(const Lags& u) const {
    const Eigen::MatrixXd x = design(u);
    return linear_algebra::Cholesky(linear_algebra::normal_matrix(x))
        .solve(x.transpose() * readings());
}

Eigen::MatrixXd TwoPathRegression::covariance(const Lags& u, const Eigen::VectorXd& beta) const {
    constexpr double kStep = 0.05;
    constexpr auto kTerms = static_cast<Index>(kTwoPathTerms);
    const Eigen::MatrixXd x = design(u);
    Eigen::MatrixXd jacobian(2 * frequencies_, kTerms + (outer_ ? 3 : 0));
    jacobian.leftCols(kLinear) = x.leftCols(kLinear);
    if (outer_) jacobian.middleCols(kTerms, 2) = x.rightCols(2);
    for (std::size_t k = 0; k < lag_count(); ++k) {
        Lags more = u, less = u;
        more[k] += kStep;
        less[k] -= kStep;
        jacobian.col(k < 3 ? kLinear + static_cast<Index>(k) : kTerms + 2) =
            (design(more) - design(less)) * beta / (2.0 * kStep);
    }
    // The error of the estimate is C (J'e + p), C = (J'J + 1)^-1, with the derivatives J of the
    // model, the noise e, and the deviations p of the true values from their priors.
    const Eigen::MatrixXd c =
        linear_algebra::Cholesky(linear_algebra::normal_matrix(jacobian)).inverse();
    return c * c + noise_covariance(jacobian * c);
}

void TwoPathRegression::update_noise(const Lags& u, const Eigen::VectorXd& beta) {
    const Eigen::VectorXd rest = readings() - design(u) * beta;
    const Eigen::ArrayXd squares =
        rest.head(frequencies_).array().square() + rest.tail(frequencies_).array().square();
    smooth_noise(0.5 * squares * noise_.array());
}

std::size_t TwoPathRegression::fast_length_within(std::size_t n) {
    while (signal::fast_length(n) != n) --n;
    return n;
}

void TwoPathRegression::set_trust(const std::vector<double>& acceleration) {
    constexpr double kLeastPower = 3.0;
    const ThermometerSpectrum spectrum =
        thermometer_spectrum(temperature_.values(), {acceleration.begin(), count_}, step_s_);
    const Eigen::Map<const Eigen::ArrayXd> power(spectrum.power.data() + 1, frequencies_);
    thermometer_noise_ = spectrum.noise;
    signal_share_ =
        (power < kLeastPower * spectrum.noise).select(0.0, 1.0 - spectrum.noise / power);
}

Eigen::VectorXd TwoPathRegression::trusted(Eigen::VectorXd column, double slope) const {
    column -= slope * ramp_;
    column.head(frequencies_).array() *= signal_share_.array();
    column.tail(frequencies_).array() *= signal_share_.array();
    return column + slope * ramp_;
}

Eigen::VectorXd TwoPathRegression::transformed(const std::vector<double>& values) const {
    const double mean = signal::mean_of(values);
    std::vector<double> centred = values;
    for (double& value : centred) value -= mean;
    const signal::Spectrum spectrum = signal::half_spectrum(centred, centred.size());
    Eigen::VectorXd parts(2 * frequencies_);
    for (Index k = 0; k < frequencies_; ++k) {
        parts(k) = spectrum[static_cast<std::size_t>(k + 1)].real();
        parts(frequencies_ + k) = spectrum[static_cast<std::size_t>(k + 1)].imag();
    }
    return parts;
}

Eigen::MatrixXd TwoPathRegression::noise_covariance(const Eigen::MatrixXd& weights) const {
    constexpr std::size_t kFiner = 8;
    const std::size_t fine = kFiner * count_;
    const auto half = static_cast<Index>(fine / 2);
    Eigen::MatrixXd parts(2 * half, weights.cols());
    for (Index m = 0; m < weights.cols(); ++m) {
        const signal::Spectrum spectrum =
            signal::half_spectrum(series_of(whitened(weights.col(m))), fine);
        for (Index k = 0; k < half; ++k) {
            const double place = static_cast<double>(k + 1) / kFiner;
            const double scale = 2.0 * std::sqrt(noise_at(place) / static_cast<double>(fine) /
                                                 static_cast<double>(count_));
            const auto value = scale * spectrum[static_cast<std::size_t>(k + 1)];
            parts(k, m) = value.real();
            parts(half + k, m) = value.imag();
        }
    }
    // normal_matrix() adds 1 to the diagonal.
    return linear_algebra::normal_matrix(parts) -
           Eigen::MatrixXd::Identity(weights.cols(), weights.cols());
}

std::vector<double> TwoPathRegression::series_of(const Eigen::VectorXd& weights) const {
    std::vector<double> of_real(count_), of_imaginary(count_), series(count_);
    for (Index k = 0; k < frequencies_; ++k) {
        of_real[static_cast<std::size_t>(k + 1)] = weights(k);
        of_imaginary[static_cast<std::size_t>(k + 1)] = weights(frequencies_ + k);
    }
    const signal::Spectrum cosines = signal::half_spectrum(of_real, count_),
                           sines = signal::half_spectrum(of_imaginary, count_);
    for (std::size_t t = 0; t < cosines.size(); ++t) {
        series[t] = cosines[t].real() + sines[t].imag();
        if (t > 0) series[count_ - t] = cosines[t].real() - sines[t].imag();
    }
    return series;
}

double TwoPathRegression::noise_at(double place) const {
    if (place <= 1.0) return noise_(0) / place;
    const auto below = std::min(static_cast<Index>(place), frequencies_) - 1;
    const auto above = std::min(below + 1, frequencies_ - 1);
    return std::lerp(noise_(below), noise_(above), place - std::floor(place));
}

Eigen::VectorXd TwoPathRegression::whitened(Eigen::VectorXd parts) const {
    parts.head(frequencies_).array() /= noise_.array().sqrt();
    parts.tail(frequencies_).array() /= noise_.array().sqrt();
    return parts;
}

void TwoPathRegression::smooth_noise(const Eigen::VectorXd& power) {
    constexpr Index kLowest = 8;
    constexpr double kBandRatio = std::numbers::sqrt2;  // half an octave
    for (Index first = kLowest; first < frequencies_;) {
        const Index end = std::min(
            frequencies_,
            std::max(first + 4, static_cast<Index>(kBandRatio * static_cast<double>(first))));
        noise_.segment(first, end - first).setConstant(power.segment(first, end - first).mean());
        first = end;
    }
    const Index lowest = std::min(kLowest, frequencies_);
    const double here = std::max(power.head(lowest).mean(), 1e-300);
    const Index beside = std::min(2 * kLowest, frequencies_ - 1);
    const double level = noise_.segment(lowest, std::max<Index>(beside - lowest, 1)).mean();
    const double middle = 0.5 * static_cast<double>(lowest + beside);
    for (Index k = 0; k < lowest; ++k)
        noise_(k) = std::max(here, level * middle / static_cast<double>(k + 1));
}

}  // namespace a351::corrector::long_record
