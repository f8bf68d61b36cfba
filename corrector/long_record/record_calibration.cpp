#include "corrector/long_record/record_calibration.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/units.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/symmetric_eigen.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::long_record {
namespace {

using Index = Eigen::Index;
constexpr int kCount = static_cast<int>(unit::kThermalNames.size());
using Vector = Eigen::Matrix<double, kCount, 1>;
using Matrix = Eigen::Matrix<double, kCount, kCount>;

constexpr Index kLevel = 0, kSlow = 1, kRate = 2, kFirstLag = 3;

constexpr double kLeastInformation = 1.0;  // information equal to that of the prior
constexpr double kOpenDeviation = 100.0;   // deviation of an undetermined direction, in the prior's
constexpr double kOneSided95 = 1.645;      // 95 % quantile of the normal distribution

/// Information of a record without the priors, in units of their deviations about their means.
struct Information {
    Matrix matrix = Matrix::Zero();
    Vector vector = Vector::Zero();  ///< matrix x estimate
};

TwoPathTerm term_of(Index k) { return kThermalOfTwoPath.at(static_cast<std::size_t>(k)); }

/// Means and deviations of the priors.
std::pair<Vector, Vector> thermal_priors() {
    const unit::ThermalResponse priors = unit::record_priors();
    return {priors.values, priors.covariance.diagonal().cwiseSqrt()};
}

Information information_of(const TwoPathFit& fit) {
    const auto [means, deviations] = thermal_priors();
    Vector estimate;
    Matrix covariance;
    for (Index i = 0; i < kCount; ++i) {
        const TwoPathTerm term = term_of(i);
        const double value = i < kFirstLag ? fit[term].value : std::log(fit[term].value);
        estimate(i) = (value - means(i)) / deviations(i);
        for (Index j = 0; j < kCount; ++j)
            covariance(i, j) =
                fit.covariance(static_cast<Index>(term), static_cast<Index>(term_of(j))) /
                (deviations(i) * deviations(j));
    }
    // The priors are independent, so that integrating out the other terms does not change theirs.
    const Matrix posterior = linear_algebra::Cholesky(covariance).inverse();
    return {0.5 * (posterior + posterior.transpose()) - Matrix::Identity(), posterior * estimate};
}

/// The part M of an information in the directions in which there is much of it.
struct InformedPart {
    Information information;
    double square = 0.0;  ///< v' M^+ v (M^+ pseudoinverse of the matrix, v the vector).
    int rank = 0;         ///< Number of these directions.
};

/// @param least  information of a direction that is in the part.
InformedPart part_of(const Information& all, double least) {
    const linear_algebra::SymmetricEigen axes = linear_algebra::symmetric_eigen(all.matrix);
    InformedPart part;
    for (Index k = 0; k < kCount; ++k) {
        if (axes.values(k) < least) continue;
        const Vector axis = axes.vectors.col(k);
        const double along = axis.dot(all.vector);
        part.information.matrix += axes.values(k) * axis * axis.transpose();
        part.information.vector += axis * along;
        part.square += along * along / axes.values(k);
        ++part.rank;
    }
    return part;
}

/// Returns the probability of the differences between records: chi-square = sum v_i' M_i^+ v_i
/// - v' M^+ v of all together, divided by kThermalErrorFactor^2.
double agreement(const std::vector<Information>& records) {
    constexpr double kNothing = 1e-6;
    Information together;
    double sum = 0.0;
    int dof = 0;
    for (const Information& record : records) {
        const InformedPart part = part_of(record, kLeastInformation);
        together.matrix += part.information.matrix;
        together.vector += part.information.vector;
        sum += part.square;
        dof += part.rank;
    }
    const InformedPart common = part_of(together, kNothing);
    if (dof == common.rank) return 1.0;
    return signal::chi_square_exceedance(
        static_cast<double>(dof - common.rank),
        std::max(0.0, sum - common.square) /
            (unit::kThermalErrorFactor * unit::kThermalErrorFactor));
}

/// Returns the response for a calibration file; undetermined directions have kOpenDeviation.
unit::ThermalResponse response_for_file(const Information& all) {
    const linear_algebra::SymmetricEigen axes = linear_algebra::symmetric_eigen(all.matrix);
    Vector values = Vector::Zero();
    Matrix covariance = Matrix::Zero();
    for (Index k = 0; k < kCount; ++k) {
        const Vector axis = axes.vectors.col(k);
        const double information = axes.values(k), along = axis.dot(all.vector);
        const bool is_told = information >= kLeastInformation;
        values += axis * along / (is_told ? information : 1.0 + std::max(0.0, information));
        covariance += (is_told ? 1.0 / information : kOpenDeviation * kOpenDeviation) * axis *
                      axis.transpose();
    }
    const auto [means, deviations] = thermal_priors();
    unit::ThermalResponse response;
    response.values = means + deviations.cwiseProduct(values);
    const Matrix scaled = deviations.asDiagonal() * covariance * deviations.asDiagonal();
    response.covariance = 0.5 * (scaled + scaled.transpose());
    return response;
}

}  // namespace

PooledThermal pool_thermal(const std::vector<TwoPathFit>& fits) {
    std::vector<Information> records;
    Information all;
    for (const TwoPathFit& fit : fits) {
        records.push_back(information_of(fit));
        all.matrix += records.back().matrix;
        all.vector += records.back().vector;
    }
    const Matrix covariance = linear_algebra::Cholesky(all.matrix + Matrix::Identity()).inverse();
    const Vector estimate = covariance * all.vector;
    const auto [means, deviations] = thermal_priors();

    PooledThermal pooled;
    for (Index k = 0; k < kCount; ++k) {
        FittedParameter parameter = fits.front()[term_of(k)];
        for (const TwoPathFit& fit : fits)
            if (!fit[term_of(k)].needed.empty()) parameter.needed = fit[term_of(k)].needed;
        const double deviation = std::sqrt(covariance(k, k));
        parameter.value = means(k) + deviations(k) * estimate(k);
        parameter.standard_error = deviations(k) * deviation;
        if (k >= kFirstLag) {
            parameter.value = std::exp(parameter.value);
            parameter.standard_error *= parameter.value;
        }
        parameter.is_determined = deviation < kDeterminedDeviation;
        if (parameter.is_determined) parameter.needed = {};
        pooled.parameters.push_back(std::move(parameter));
    }
    Vector both = Vector::Zero();
    both(kLevel) = deviations(kLevel);
    both(kSlow) = deviations(kSlow);
    pooled.static_slope = both.dot(estimate);
    pooled.static_slope_error = std::sqrt(both.dot(covariance * both));
    pooled.is_static_slope_determined =
        pooled.static_slope_error < kDeterminedDeviation * both.norm();
    pooled.agreement_p = agreement(records);
    if (pooled.parameters[kRate].is_determined || pooled.is_static_slope_determined)
        pooled.response = response_for_file(all);
    return pooled;
}

std::string reason_against_two_paths(const std::vector<double>& temperature_degc,
                                     const std::vector<double>& acceleration_mgal, double step_s) {
    const ResponseOptions options{.is_joint = true};
    const ResponsePoint* at_cycle = nullptr;
    const auto points = response_by_spectrum(temperature_degc, acceleration_mgal, step_s, options);
    for (const ResponsePoint& point : points) {
        if (point.refusal.empty()) return {};
        if (point.shortest_s <= options.cycle_s) at_cycle = &point;
    }
    std::string reason = "no response to temperature in any band";
    if (at_cycle != nullptr)
        reason += fmt::format(", at the oven's cycle: {}; needed: {}", at_cycle->refusal,
                              at_cycle->needed);
    return reason;
}

WarmUpReading warm_up_guidance(const TwoPathFit& fit, double begins_after_h, double length_h,
                               double within_mgal) {
    const FittedParameter &size = fit[TwoPathTerm::warm_up], &time = fit[TwoPathTerm::warm_up_time];
    const double time_h = time.value / kSecondsPerHour;
    const std::string shown =
        fmt::format("warm-up of {} +- {} mGal at the start of the record, time constant {} +- {} h",
                    text::fixed(size.value, 1), text::fixed(size.standard_error, 1),
                    text::fixed(time_h, 1), text::fixed(time.standard_error / kSecondsPerHour, 1));
    if (!size.is_determined || !time.is_determined ||
        std::abs(size.value) < 2.0 * size.standard_error)
        return {std::nullopt, shown +
                                  ": the record does not determine it; needed: a record of a day "
                                  "or more that begins when the sensor is switched on"};
    const double ratio = std::log(std::abs(size.value) / within_mgal);
    // Derivatives of tW ln(|w| / within) by ln(tW) and by w.
    const Eigen::Vector2d slopes(time_h * ratio, time_h / size.value);
    constexpr auto kTime = static_cast<Index>(TwoPathTerm::warm_up_time),
                   kSize = static_cast<Index>(TwoPathTerm::warm_up);
    Eigen::Matrix2d covariance;
    covariance << fit.covariance(kTime, kTime), fit.covariance(kTime, kSize),
        fit.covariance(kSize, kTime), fit.covariance(kSize, kSize);
    const double error_h = std::sqrt(slopes.dot(covariance * slopes));
    const double after_h = std::max(0.0, time_h * ratio + kOneSided95 * error_h);
    if (after_h > length_h)
        return {std::nullopt,
                fmt::format("{}: within {} mGal only after {} h, and the record ends before; "
                            "needed: {} h or more",
                            shown, text::fixed(within_mgal, 2), text::fixed(after_h, 1),
                            text::fixed(after_h, 0))};
    return {unit::WarmUpGuidance{within_mgal, begins_after_h + after_h},
            fmt::format("{}: within {} mGal {} h after power-on, {} h with 95 % confidence", shown,
                        text::fixed(within_mgal, 2),
                        text::fixed(begins_after_h + std::max(0.0, time_h * ratio), 1),
                        text::fixed(begins_after_h + after_h, 1))};
}

}  // namespace a351::corrector::long_record
