#include "corrector/series/tumble_series.hpp"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "corrector/series/series_rows.hpp"
#include "corrector/whole_day/day_noise.hpp"
#include "protocol/core/units.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::series {
namespace {

using Index = Eigen::Index;

// Least share of gravity along an axis that is up or down: within 26 deg.
constexpr double kUpright = 0.9;

// Places of the parameters: three biases, scales, quadratic terms, angles, changes of the biases and of
// the scales with temperature, and the error of gravity.
constexpr Index kBias = 0, kScale = 3, kQuadratic = 6, kAngle = 9, kByTemperature = 12,
                kScaleByTemperature = 15, kGravity = 18, kParameters = 19;
using Parameters = Eigen::Matrix<double, kParameters, 1>;
using Covariance = Eigen::Matrix<double, kParameters, kParameters>;

// Pairs of axes in the order of Tumble::angle_rad.
constexpr std::array<std::array<Index, 2>, 3> kPairs{{{0, 1}, {0, 2}, {1, 2}}};

// Deviations of the priors.  Those of bias and scale are free: fifty times the data sheet's 2 Gal, and
// 10 %.  Quadratic term: nonlinearity of 0.03 % at 1 g.  Angle: cross-axis sensitivity of 0.2 % in each
// of two axes.  Temperature: 0.1 mg/degC.  Source: data sheet of the M-A352, tables 2.2 to 2.4.
constexpr double kFreeBias_mgal = 1e5, kFreeScale = 0.1, kQuadratic_mgal = 300.0, kAngle_rad = 3e-3,
                 kByTemperature_mgal_per_degc = 100.0;
// Uncertainty of an exact gravity; a smaller one has no effect.
constexpr double kLeastGravityError_mgal = 1e-3;
// Share of the prior's deviation up to which a term counts as determined.
constexpr double kDeterminedShare = 0.5;
// Bias of a horizontal axis that the whole-day model expects, mGal/g: a larger error is no help.
constexpr double kUsefulBias_mgal_per_g = 300.0;
// Error of a change with temperature above which it is not written: a tenth of a usual unit's steady
// response would be this.  A larger error says little about the share of the scale.
constexpr double kUsefulSlope_mgal_per_degc =
    -0.1 * (unit::kTypicalUnit.level_mgal_per_degc + unit::kTypicalUnit.slow_mgal_per_degc);
// Temperature at which unit::Faces has its constants.  It belongs to the format of calibrations.
constexpr double kFacesTemperature_degc = 42.5;

/// A position: mean vector, temperature above the mean, gravity with its tide, error of the reading.
struct Position {
    Eigen::Vector3d mean_mgal;
    double degc = 0.0, gravity_mgal = 0.0, error_mgal = 0.0;
};

std::vector<Position> positions_of(const CheckedSeries& checked) {
    checked.require_one_point();
    std::vector<Position> positions;
    for (const reading::SurveyRow& row : checked.read.rows) {
        if (!row.reference)
            checked.refuse(fmt::format("the gravity of {} is not known", row.site),
                           "a gravity_mgal in the table of sites");
        if (!is_in_series(row)) continue;
        const reading::RecordSummary& record = row.axes_for("tumble");
        Position position;
        position.mean_mgal =
            kMilliGalPerStandardGravity *
            Eigen::Vector3d(record.x.mean.value(), record.y.mean.value(), record.z.mean.value());
        position.degc = row.temperature.value();
        position.gravity_mgal = (*row.reference + row.tide).value();
        const double white_mgal = record.standard_error.value_or(MilliGal(0.0)).value();
        position.error_mgal = std::hypot(whole_day::kUsualNoise.placement_mgal,
                                         whole_day::kUsualNoise.flicker_mgal, white_mgal);
        positions.push_back(position);
    }
    return positions;
}

void require_all_up_and_down(const std::vector<Position>& positions, const CheckedSeries& checked) {
    for (Index axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            if (std::ranges::any_of(positions, [&](const Position& position) {
                    return sign * position.mean_mgal(axis) > kUpright * position.gravity_mgal;
                }))
                continue;
            checked.refuse(fmt::format("no position with {} {}", kTumbleAxes[std::size_t(axis)],
                                       sign > 0.0 ? "up" : "down"),
                           "six or more positions, each axis up and down");
        }
}

Parameters prior_deviations(double u_gravity_mgal) {
    Parameters deviations;
    deviations << Eigen::Vector3d::Constant(kFreeBias_mgal), Eigen::Vector3d::Constant(kFreeScale),
        Eigen::Vector3d::Constant(kQuadratic_mgal), Eigen::Vector3d::Constant(kAngle_rad),
        Eigen::Vector3d::Constant(kByTemperature_mgal_per_degc),
        Eigen::Vector3d::Constant(kByTemperature_mgal_per_degc / kMilliGalPerStandardGravity),
        std::max(u_gravity_mgal, kLeastGravityError_mgal);
    return deviations;
}

/// Returns the acceleration along the axes, mGal, that gives the mean vector.
Eigen::Vector3d true_vector(const Position& position, const Parameters& at) {
    constexpr int kRounds = 20;  // each leaves at most 10 % of the change of the round before
    const Eigen::Vector3d bias =
        at.segment<3>(kBias) + position.degc * at.segment<3>(kByTemperature);
    const Eigen::Vector3d scale =
        at.segment<3>(kScale) + position.degc * at.segment<3>(kScaleByTemperature);
    Eigen::Matrix3d cross = Eigen::Matrix3d(scale.asDiagonal());
    for (std::size_t k = 0; k < kPairs.size(); ++k)
        cross(kPairs[k][0], kPairs[k][1]) = cross(kPairs[k][1], kPairs[k][0]) =
            0.5 * at(kAngle + Index(k));
    Eigen::Vector3d a = position.mean_mgal;
    for (int round = 0; round < kRounds; ++round) {
        const Eigen::Vector3d quadratic =
            at.segment<3>(kQuadratic).cwiseProduct(a.cwiseProduct(a)) /
            kMilliGalPerStandardGravity / kMilliGalPerStandardGravity;
        a = position.mean_mgal - bias - cross * a - quadratic;
    }
    return a;
}

/// Returns how |m| changes with the parameters at the true vector.
Parameters row_of(const Position& position, const Eigen::Vector3d& a) {
    const Eigen::Vector3d n = a.normalized();
    const Eigen::Vector3d in_g = a / kMilliGalPerStandardGravity;
    Parameters row;
    row.segment<3>(kBias) = n;
    row.segment<3>(kScale) = n.cwiseProduct(a);
    row.segment<3>(kQuadratic) = n.cwiseProduct(in_g.cwiseProduct(in_g));
    for (std::size_t k = 0; k < kPairs.size(); ++k)
        row(kAngle + Index(k)) = n(kPairs[k][0]) * a(kPairs[k][1]);
    row.segment<3>(kByTemperature) = position.degc * n;
    row.segment<3>(kScaleByTemperature) = position.degc * n.cwiseProduct(a);
    row(kGravity) = 1.0;
    return row;
}

/// Parameters with their covariance, and the weighted sum of squared residuals.
struct Solution {
    Parameters values = Parameters::Zero();
    Covariance covariance;
    double chi_square = 0.0;
    double left_over = 0.0;  ///< Number of positions minus that of parameters they determine.
};

Solution solve(const std::vector<Position>& positions, const Parameters& deviations) {
    constexpr int kRounds = 12;  // each leaves about 2 % of the change of the round before
    const auto count = static_cast<Index>(positions.size());
    Solution found;
    // In units of the priors' deviations, so that the normal matrix is 1 + data.
    Eigen::MatrixXd rows(count, kParameters);
    Eigen::VectorXd residuals(count);
    for (int round = 0; round < kRounds; ++round) {
        for (Index i = 0; i < count; ++i) {
            const Position& position = positions[std::size_t(i)];
            const Eigen::Vector3d a = true_vector(position, found.values);
            rows.row(i) = row_of(position, a).cwiseProduct(deviations) / position.error_mgal;
            residuals(i) =
                (a.norm() - position.gravity_mgal - found.values(kGravity)) / position.error_mgal;
        }
        const Covariance inverse =
            linear_algebra::Cholesky(linear_algebra::normal_matrix(rows)).inverse();
        const Eigen::VectorXd readings = residuals + rows * found.values.cwiseQuotient(deviations);
        found.values = (inverse * rows.transpose() * readings).cwiseProduct(deviations);
        found.covariance = deviations.asDiagonal() * inverse * deviations.asDiagonal();
        found.chi_square = residuals.squaredNorm();
        found.left_over = static_cast<double>(count - kParameters) + inverse.trace();
    }
    return found;
}

/// A term that is a linear combination of parameters.
TumbleTerm term(const Solution& found, const Parameters& deviations, const Parameters& weights) {
    const double error = std::sqrt(weights.dot(found.covariance * weights));
    return {weights.dot(found.values), error,
            error < kDeterminedShare * weights.cwiseProduct(deviations).norm()};
}

Parameters along(Index place, double weight = 1.0) { return weight * Parameters::Unit(place); }

void set_terms(Tumble& tumble, const Solution& found, const Parameters& deviations) {
    const double gravity_mgal = tumble.gravity.value();
    const double in_g = gravity_mgal / kMilliGalPerStandardGravity;
    const auto named = [&](const Parameters& weights) { return term(found, deviations, weights); };
    for (Index k = 0; k < 3; ++k) {
        TumbleAxis& axis = tumble.axes.at(std::size_t(k));
        axis.zero_mgal = named(along(kBias + k) + along(kQuadratic + k, in_g * in_g));
        axis.scale = named(along(kScale + k));
        axis.scale.value += 1.0;
        axis.bias_mgal = named(along(kBias + k));
        axis.bias_mgal.is_determined =
            axis.bias_mgal.standard_error < kDeterminedShare * kQuadratic_mgal;
        axis.quadratic_mgal = named(along(kQuadratic + k));
        axis.bias_mgal_per_degc = named(along(kByTemperature + k));
        axis.scale_mgal_per_degc =
            named(along(kScaleByTemperature + k, kMilliGalPerStandardGravity));
        tumble.angle_rad.at(std::size_t(k)) = named(along(kAngle + k));
    }
    // d|m| / dg with z upwards.
    const double by_quadratic = 2.0 * in_g / kMilliGalPerStandardGravity;
    tumble.slope = named(along(kScale + 2) + along(kQuadratic + 2, by_quadratic));
    tumble.slope.value += 1.0;
    tumble.slope.is_determined =
        tumble.slope.standard_error < kDeterminedShare * by_quadratic * kQuadratic_mgal;
    constexpr double kLeastScaleError = 1e-6;
    tumble.scale = {tumble.slope.value, std::max(tumble.slope.standard_error, kLeastScaleError)};
    Eigen::Matrix<double, 2, kParameters> horizontal;
    horizontal << (along(kBias) + along(kAngle + 1, gravity_mgal)).transpose(),
        (along(kBias + 1) + along(kAngle + 2, gravity_mgal)).transpose();
    unit::AxisBias bias;
    bias.values = horizontal * found.values;
    const Eigen::Matrix2d covariance = horizontal * found.covariance * horizontal.transpose();
    bias.covariance << covariance(0, 0), covariance(0, 1), covariance(0, 1), covariance(1, 1);
    if (std::sqrt(covariance.diagonal().maxCoeff()) < kUsefulBias_mgal_per_g)
        tumble.axis_bias = bias;
    const double above = kFacesTemperature_degc - tumble.mean_degc;
    const Parameters bias_slope = along(kByTemperature + 2),
                     scale_slope = along(kScaleByTemperature + 2, kMilliGalPerStandardGravity);
    Eigen::Matrix<double, 4, kParameters> faces;
    faces
        << (along(kBias + 2) + along(kQuadratic + 2, in_g * in_g) + above * bias_slope).transpose(),
        (along(kScale + 2, kMilliGalPerStandardGravity) + above * scale_slope).transpose(),
        bias_slope.transpose(), scale_slope.transpose();
    const Eigen::Matrix4d of_faces = faces * found.covariance * faces.transpose();
    if (std::sqrt(of_faces.diagonal().tail<2>().maxCoeff()) < kUsefulSlope_mgal_per_degc)
        tumble.faces = {faces * found.values, 0.5 * (of_faces + of_faces.transpose())};
}

}  // namespace

Tumble measure_tumble(const reading::OccupationRows& read, const std::string& origin) {
    const CheckedSeries checked{"tumble", origin, read};
    std::vector<Position> positions = positions_of(checked);
    require_all_up_and_down(positions, checked);
    Tumble tumble;
    tumble.positions = positions.size();
    tumble.gravity = *read.rows.front().reference;
    tumble.u_gravity = read.rows.front().u_reference;
    const auto [coldest, warmest] = std::ranges::minmax(positions, {}, &Position::degc);
    tumble.range_degc = warmest.degc - coldest.degc;
    double variance = 0.0;
    for (const Position& position : positions) {
        tumble.mean_degc += position.degc / static_cast<double>(positions.size());
        variance += std::pow(position.error_mgal, 2) / static_cast<double>(positions.size());
    }
    tumble.expected_mgal = std::sqrt(variance);
    for (Position& position : positions) position.degc -= tumble.mean_degc;

    const Parameters deviations =
        prior_deviations(tumble.u_gravity.value_or(MilliGal(0.0)).value());
    Solution found = solve(positions, deviations);
    if (found.left_over >= 1.0) {
        const double ratio = found.chi_square / found.left_over;
        tumble.residual_mgal = tumble.expected_mgal * std::sqrt(ratio);
        if (ratio > 1.0) {
            for (Position& position : positions) position.error_mgal *= std::sqrt(ratio);
            found = solve(positions, deviations);
        }
    }
    set_terms(tumble, found, deviations);
    return tumble;
}

}  // namespace a351::corrector::series
