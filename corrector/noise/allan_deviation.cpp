#include "corrector/noise/allan_deviation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "protocol/signal/distributions.hpp"
#include "protocol/signal/moments.hpp"

namespace a351::corrector::noise {
namespace {

/// Returns the effect of the three squared noises on the variance of averages over t, unit noises.
Eigen::Vector3d variances_at(double t) {
    return {1.0 / t, 2.0 * std::numbers::ln2 / std::numbers::pi, t / 3.0};
}

/// The covariance of the Allan variances as a function of the squared noises per sample.  It is a sum
/// of their products, each with a matrix.
class Covariance {
public:
    /// @param averages  numbers of samples of the averages.
    explicit Covariance(const std::vector<std::ptrdiff_t>& averages) : averages_(averages) {
        const auto size = static_cast<Eigen::Index>(averages.size());
        for (auto& matrix : of_products_) matrix = Eigen::MatrixXd::Zero(size, size);
    }

    /// Adds a part of n samples, independent of the others.
    /// @param weights  its share in the variance of each average; 0: it is too short for it.
    void add(std::ptrdiff_t n, const Eigen::VectorXd& weights) {
        std::vector<double> flicker(static_cast<std::size_t>(n) + 1, 0.0);
        for (std::size_t k = 1; k < flicker.size(); ++k) {
            const auto t = static_cast<double>(k);
            flicker[k] = t * t * std::log(t) / (2.0 * std::numbers::pi);
        }
        for (Eigen::Index i = 0; i < weights.size() && weights(i) > 0.0; ++i)
            for (Eigen::Index k = 0; k <= i; ++k) {
                const auto products =
                    sums_of_products(n, averages_[static_cast<std::size_t>(i)],
                                     averages_[static_cast<std::size_t>(k)], flicker);
                for (std::size_t p = 0; p < products.size(); ++p) {
                    of_products_[p](i, k) += weights(i) * weights(k) * products[p];
                    of_products_[p](k, i) = of_products_[p](i, k);
                }
            }
    }

    [[nodiscard]] Eigen::MatrixXd at(const Eigen::Vector3d& squares) const {
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(of_products_[0].rows(), of_products_[0].cols());
        std::size_t p = 0;
        for (Eigen::Index i = 0; i < 3; ++i)
            for (Eigen::Index k = 0; k <= i; ++k)
                sum += (i == k ? 1.0 : 2.0) * squares(i) * squares(k) * of_products_[p++];
        return sum;
    }

private:
    using Products = std::array<double, 6>;  ///< 00, 10, 11, 20, 21, 22

    /// Returns 1/2 mean over i, k of the products of r_ml(k - i) of each two noises.
    static Products sums_of_products(std::ptrdiff_t n, std::ptrdiff_t m, std::ptrdiff_t l,
                                     const std::vector<double>& flicker) {
        constexpr std::array<double, 3> kDifference{1.0, -2.0, 1.0};
        const std::ptrdiff_t count_m = n - 2 * m + 1, count_l = n - 2 * l + 1;
        Products sums{};
        for (std::ptrdiff_t j = 1 - count_m; j < count_l; ++j) {
            std::array<double, 3> r{};
            // Where no argument changes its sign, the differences of powers below 4 are 0.
            const bool is_far = j - 2 * m > 0 || j + 2 * l < 0;
            for (std::ptrdiff_t a = 0; a < 3; ++a)
                for (std::ptrdiff_t b = 0; b < 3; ++b) {
                    const double c = kDifference[static_cast<std::size_t>(a)] *
                                     kDifference[static_cast<std::size_t>(b)];
                    const auto k = static_cast<std::size_t>(std::abs(j + b * l - a * m));
                    r[1] += c * flicker[k];
                    if (is_far) continue;
                    const auto t = static_cast<double>(k);
                    r[0] -= c * t / 2.0;
                    r[2] += c * t * t * t / 12.0;
                }
            const auto pairs = static_cast<double>(std::min(count_l - 1, count_m - 1 + j) -
                                                   std::max<std::ptrdiff_t>(0, j) + 1);
            std::size_t p = 0;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k <= i; ++k) sums[p++] += pairs * r[i] * r[k];
        }
        const auto scale = static_cast<double>(m * l);
        for (double& sum : sums)
            sum *=
                0.5 / (scale * scale * static_cast<double>(count_m) * static_cast<double>(count_l));
        return sums;
    }

    const std::vector<std::ptrdiff_t>& averages_;
    std::array<Eigen::MatrixXd, 6> of_products_;
};

/// Minimises the squares of the misfits over squares that are not negative, by coordinate descent,
/// which converges because they are convex.
Eigen::Vector3d not_negative(const Eigen::Matrix3d& normal, const Eigen::Vector3d& right) {
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    constexpr int kRounds = 10'000;
    for (int round = 0; round < kRounds; ++round)
        for (Eigen::Index i = 0; i < squares.size(); ++i) {
            const double rest = right(i) - normal.row(i).dot(squares) + normal(i, i) * squares(i);
            squares(i) = normal(i, i) > 0.0 ? std::max(0.0, rest / normal(i, i)) : 0.0;
        }
    return squares;
}

/// The squared noises, per sample, not negative.
struct Fit {
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    Eigen::MatrixXd weights;
};

/// Probability below which the noises do not describe the record.
constexpr double kMisfit = 0.001;

/// Returns the squares s from which an estimate differs by at most signal::kNormal95 standard errors.
///
/// The square of the standard error is variance[0] + variance[1] s + variance[2] s^2.  It belongs
/// to s and not to the estimate, because it would be too small for an estimate of 0.
Limits limits_of(double estimate, const std::array<double, 3>& variance) {
    constexpr double z2 = signal::kNormal95 * signal::kNormal95;
    // (s - estimate)^2 = z^2 variance: a s^2 - 2 b s + c = 0
    const double a = 1.0 - z2 * variance[2], b = estimate + 0.5 * z2 * variance[1],
                 c = estimate * estimate - z2 * variance[0];
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    if (a > 0.0) return {estimate, std::max(0.0, (b - root) / a), std::max(0.0, (b + root) / a)};
    // The error grows with s as fast as s does, so that nothing limits it above.
    const double above = b * b > a * c ? (b - root) / a : 0.0;
    return {estimate, estimate > above ? std::max(0.0, above) : 0.0,
            std::numeric_limits<double>::infinity()};
}

Fit fit(const Eigen::MatrixXd& design, const Eigen::VectorXd& variances, Eigen::MatrixXd weights) {
    const Eigen::Matrix3d normal = design.transpose() * weights * design;
    return {not_negative(normal, design.transpose() * weights * variances), std::move(weights)};
}

/// Fits the noises, with limits if they describe the record.
ThreeNoises fit_noises(const Eigen::VectorXd& variances,
                       const std::vector<std::ptrdiff_t>& averages, const Covariance& covariance,
                       Eigen::Vector3d& squares) {
    const Eigen::Index size = variances.size();
    Eigen::MatrixXd design(size, 3);
    Eigen::VectorXd by_number(size);  // weights of relative misfits by the number of averages
    for (Eigen::Index i = 0; i < size; ++i) {
        const auto samples = static_cast<double>(averages[static_cast<std::size_t>(i)]);
        design.row(i) = variances_at(samples);
        by_number(i) = 1.0 / (samples * variances(i) * variances(i));
    }
    const Fit simple = fit(design, variances, by_number.asDiagonal());
    Fit best = simple;
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round)
        best = fit(design, variances,
                   covariance.at(best.squares).ldlt().solve(Eigen::MatrixXd::Identity(size, size)));
    const Eigen::VectorXd misfits = variances - design * best.squares;
    ThreeNoises noises;
    noises.describes_record = signal::chi_square_exceedance(
                                  static_cast<double>(size - (best.squares.array() > 0.0).count()),
                                  misfits.dot(best.weights * misfits)) > kMisfit;
    squares = noises.describes_record ? best.squares : simple.squares;
    std::array<Limits*, 3> levels{&noises.white_mgal_sqrt_s, &noises.flicker_mgal,
                                  &noises.walk_mgal_per_sqrt_s};
    const Eigen::MatrixXd estimator = (design.transpose() * best.weights * design)
                                          .ldlt()
                                          .solve(design.transpose() * best.weights);
    const Eigen::Vector3d estimates = estimator * variances;
    for (Eigen::Index i = 0; i < 3; ++i) {
        Limits& level = *levels[static_cast<std::size_t>(i)];
        level = {squares(i), squares(i), squares(i)};
        if (!noises.describes_record) continue;
        const auto variance_at = [&](double square) {
            Eigen::Vector3d truth = squares;
            truth(i) = square;
            return estimator.row(i).dot(covariance.at(truth) * estimator.row(i).transpose());
        };
        // A quadratic function of the square: three values determine it.
        const double unit = std::max(squares.sum(), variances(0));
        const double at_0 = variance_at(0.0), at_1 = variance_at(unit),
                     at_2 = variance_at(2.0 * unit);
        const Limits limits =
            limits_of(estimates(i), {at_0, (4.0 * at_1 - at_2 - 3.0 * at_0) / (2.0 * unit),
                                     (at_2 - 2.0 * at_1 + at_0) / (2.0 * unit * unit)});
        level.low = std::min(level.value, limits.low);
        level.high = std::max(level.value, limits.high);
    }
    return noises;
}

/// Returns the roots of squares per sample, in another unit.
Limits level(const Limits& square, double unit) {
    return {unit * std::sqrt(square.value), unit * std::sqrt(square.low),
            unit * std::sqrt(square.high)};
}

}  // namespace

double ThreeNoises::deviation_mgal(double averaging_s) const {
    const Eigen::Vector3d levels(white_mgal_sqrt_s.value, flicker_mgal.value,
                                 walk_mgal_per_sqrt_s.value);
    return std::sqrt(variances_at(averaging_s).dot(levels.cwiseAbs2()));
}

double ThreeNoises::density_mgal2_per_hz(double frequency_hz) const {
    const double white = white_mgal_sqrt_s.value, flicker = flicker_mgal.value,
                 walk = walk_mgal_per_sqrt_s.value / (std::numbers::pi * frequency_hz);
    return 2.0 * white * white + flicker * flicker / (std::numbers::pi * frequency_hz) +
           0.5 * walk * walk;
}

AllanAnalysis analyse_allan(const std::vector<double>& values, double step_s) {
    return pooled_allan({values}, step_s);
}

AllanAnalysis pooled_allan(const std::vector<std::vector<double>>& parts, double step_s) {
    std::ptrdiff_t longest = 0;
    for (const std::vector<double>& part : parts) longest = std::max(longest, std::ssize(part));
    std::vector<std::ptrdiff_t> averages;
    for (std::ptrdiff_t m = 1; m <= longest / 4; m *= 2) averages.push_back(m);
    const auto size = static_cast<Eigen::Index>(averages.size());
    // Numbers of differences of each part (row), 0 if it is shorter than four averages.
    Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(std::ssize(parts), size);
    Eigen::VectorXd variances = Eigen::VectorXd::Zero(size);
    AllanAnalysis analysis;
    for (Eigen::Index i = 0; i < size; ++i) {
        const std::ptrdiff_t m = averages[static_cast<std::size_t>(i)];
        for (Eigen::Index p = 0; p < counts.rows(); ++p) {
            const std::vector<double>& part = parts[static_cast<std::size_t>(p)];
            if (std::ssize(part) < 4 * m) continue;
            counts(p, i) = static_cast<double>(std::ssize(part) - 2 * m + 1);
            const double deviation = allan_deviation(part, static_cast<std::size_t>(m));
            variances(i) += counts(p, i) * deviation * deviation;
        }
        variances(i) /= counts.col(i).sum();
        const double deviation = std::sqrt(variances(i));
        analysis.points.push_back({.averaging_s = static_cast<double>(m) * step_s,
                                   .deviation_mgal = {deviation, deviation, deviation}});
    }
    if (!(variances.size() > 0 && variances.minCoeff() > 0.0)) {  // A constant record has no noise.
        analysis.noises.describes_record = true;
        return analysis;
    }
    Covariance covariance(averages);
    for (Eigen::Index p = 0; p < counts.rows(); ++p)
        covariance.add(std::ssize(parts[static_cast<std::size_t>(p)]),
                       counts.row(p).transpose().cwiseQuotient(counts.colwise().sum().transpose()));
    Eigen::Vector3d squares;
    ThreeNoises& noises = analysis.noises = fit_noises(variances, averages, covariance, squares);
    noises.white_mgal_sqrt_s = level(noises.white_mgal_sqrt_s, std::sqrt(step_s));
    noises.flicker_mgal = level(noises.flicker_mgal, 1.0);
    noises.walk_mgal_per_sqrt_s = level(noises.walk_mgal_per_sqrt_s, 1.0 / std::sqrt(step_s));
    const Eigen::VectorXd expected_variances = covariance.at(squares).diagonal();
    for (std::size_t i = 0; i < averages.size(); ++i) {
        AllanPoint& point = analysis.points[i];
        point.model_mgal = analysis.noises.deviation_mgal(point.averaging_s);
        if (!noises.describes_record) continue;
        // chi-square with nu degrees of freedom has the relative variance 2 / nu.
        const auto k = static_cast<Eigen::Index>(i);
        const double expected = point.model_mgal * point.model_mgal;
        const Limits limits =
            variance_limits(variances(k), 2.0 * expected * expected / expected_variances(k));
        point.deviation_mgal.low = std::sqrt(limits.low);
        point.deviation_mgal.high = std::sqrt(limits.high);
    }
    return analysis;
}

double scatter_apart(const std::vector<double>& values, std::size_t samples, std::size_t apart) {
    std::vector<double> sums(values.size() + 1, 0.0);
    const double mean = signal::mean_of(values);
    for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i] - mean;
    // With cumulative sums s: sigma^2 = 1/2 mean ((s[i+a+m] - s[i+a] - s[i+m] + s[i]) / m)^2
    const std::size_t count = values.size() - apart - samples + 1;
    double squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double change =
            (sums[i + apart + samples] - sums[i + apart] - sums[i + samples] + sums[i]) /
            static_cast<double>(samples);
        squares += change * change;
    }
    return std::sqrt(0.5 * squares / static_cast<double>(count));
}

double allan_deviation(const std::vector<double>& values, std::size_t samples) {
    return scatter_apart(values, samples, samples);
}

}  // namespace a351::corrector::noise
