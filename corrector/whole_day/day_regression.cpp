#include "corrector/whole_day/day_regression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "protocol/core/units.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/unit/calibration.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

// day_model.hpp lists the priors; corrector/methods.md gives their origin.
constexpr LogNormalPrior kFlickerPrior_mgal{kUsualNoise.flicker_mgal, 2.0};
constexpr double kWhiteFactor = 2.0;

/// Returns a robust scatter of the bins, mGal: 1.4826 median |difference of neighbours| / sqrt(2),
/// at least 1e-3.  It is the median of the white noise's prior.
double bin_scatter_mgal(const std::vector<reading::DayBin>& bins) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < bins.size(); ++i)
        if (bins[i].set_up == bins[i - 1].set_up)
            steps.push_back(std::abs((bins[i].reading - bins[i - 1].reading).value()));
    if (steps.empty()) return 1.0;
    return std::max(signal::kGaussianPerMad * signal::median(std::move(steps)) / std::sqrt(2.0),
                    1e-3);
}

}  // namespace

DayRegression::DayRegression(const DaySurvey& survey, const std::vector<double>& rough_mgal)
    : record_(*survey.record),
      stations_(survey.stations),
      priors_(survey.priors),
      whitening_(record_.bins),
      white_mgal_{bin_scatter_mgal(record_.bins), kWhiteFactor},
      has_two_faces_(reading::has_two_faces(record_.bins)),
      temperature_(survey.temperature ? survey.temperature
                                      : std::make_shared<const LaggedMeans>(record_)) {
    faces_.resize(std::ssize(record_.bins));
    for (Index i = 0; i < faces_.size(); ++i)
        faces_(i) = record_.bins[static_cast<std::size_t>(i)].face;
    set_states();
    set_gravities();
    set_readings(rough_mgal);
    set_fixed_columns();
}

void DayRegression::set_states() {
    const double fast_lag_s = lag_s({}, kFastLag), slow_lag_s = lag_s({}, kSlowLag);
    states_ = lag_states(record_.temperature, fast_lag_s, slow_lag_s);
    // Root of the mean square of a slope, by its prior.
    const auto size = [this](DayTerm term) {
        const Index place = DayPriors::place_of(term);
        return std::hypot(priors_.mean(place), priors_.factor.row(place).norm());
    };
    const double of_fast = size(DayTerm::fast) * kSecondsPerHour / fast_lag_s;
    // Short gaps have no effect that matters, and each state is one more column.
    constexpr double kLeastEffect_mgal = 0.05;
    std::erase_if(states_, [&](const LagStates& state) {
        return of_fast * state.fast_sd_degc < kLeastEffect_mgal &&
               size(DayTerm::slow) * state.slow_sd_degc < kLeastEffect_mgal;
    });
    states_sd_mgal_.resize(2 * static_cast<Index>(states_.size()));
    for (std::size_t k = 0; k < states_.size(); ++k)
        states_sd_mgal_.segment<2>(2 * static_cast<Index>(k)) << of_fast * states_[k].fast_sd_degc,
            size(DayTerm::slow) * states_[k].slow_sd_degc;
}

void DayRegression::set_gravities() {
    std::size_t numbers = 0;
    for (const DayStation& station : stations_) numbers = std::max(numbers, station.number + 1);
    std::vector<double> deviations(numbers, kFreeGravity_mgal);
    base_mgal_.resize(numbers);
    is_held_.resize(numbers);
    for (const DayStation& station : stations_) {
        if (!station.gravity) continue;
        is_held_[station.number] = true;
        base_mgal_[station.number] = station.gravity->value();
        deviations[station.number] = station.u_gravity.value();
    }
    std::vector<double> estimated;
    for (const double deviation : deviations) {
        places_.push_back(deviation > 0.0 ? kTerms + std::ssize(estimated) : -1);
        if (deviation > 0.0) estimated.push_back(deviation);
    }
    for (const DayStation& station : stations_)
        step_count_ = std::max(step_count_, static_cast<Index>(station.steps));
    estimated.insert(estimated.end(), static_cast<std::size_t>(step_count_), kFreeGravity_mgal);
    gravity_sd_mgal_ = Eigen::Map<const Eigen::VectorXd>(estimated.data(), std::ssize(estimated));
}

void DayRegression::set_readings(const std::vector<double>& rough_mgal) {
    const auto count = static_cast<Index>(record_.bins.size());
    readings_mgal_.resize(count);
    double held_sum = 0.0, held_count = 0.0;
    std::vector<double> sums(places_.size()), counts(sums.size()), faces(sums.size());
    for (Index i = 0; i < count; ++i) {
        const reading::DayBin& bin = record_.bins[static_cast<std::size_t>(i)];
        const DayStation& station = stations_[bin.set_up];
        readings_mgal_(i) = (bin.reading - bin.tide).value();
        if (is_held_[station.number]) {
            held_sum += bin.face * (readings_mgal_(i) - base_mgal_[station.number]);
            held_count += 1.0;
        } else {
            sums[station.number] += readings_mgal_(i);
            counts[station.number] += 1.0;
            faces[station.number] += bin.face;
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k)
        if (!rough_mgal.empty() && !is_held_[k])
            base_mgal_[k] = rough_mgal[k];
        else if (counts[k] > 0.0)
            base_mgal_[k] = sums[k] / counts[k] - faces[k] / counts[k] * (held_sum / held_count);
    for (Index i = 0; i < count; ++i) {
        const reading::DayBin& bin = record_.bins[static_cast<std::size_t>(i)];
        readings_mgal_(i) =
            bin.face * (readings_mgal_(i) - base_mgal_[stations_[bin.set_up].number]);
    }
}

void DayRegression::set_fixed_columns() {
    const auto count = static_cast<Index>(record_.bins.size());
    fixed_ = Eigen::MatrixXd::Zero(count, estimated());
    const auto column = [this](DayTerm term) { return fixed_.col(static_cast<Index>(term)); };
    column(DayTerm::constant).setOnes();
    column(DayTerm::level) =
        means().of(record_.temperature.series.values()).array() - unit::kTypicalUnit.set_point_degc;
    const UtcTime begin = record_.temperature.series.start();
    const UtcTime middle =
        record_.bins.front().time + (record_.bins.back().time - record_.bins.front().time) / 2;
    const auto first_held = std::ranges::find_if(record_.bins, [this](const reading::DayBin& bin) {
        return is_held_[stations_[bin.set_up].number];
    });
    const reading::DayBin& zero =
        first_held == record_.bins.end() ? record_.bins.front() : *first_held;
    // In one face the constant takes the scale's part in all gravities; in two it cannot.
    const double zero_mgal = has_two_faces_ ? 0.0 : base_mgal_[stations_[zero.set_up].number];
    for (Index i = 0; i < count; ++i) {
        const reading::DayBin& bin = record_.bins[static_cast<std::size_t>(i)];
        column(DayTerm::scale)(i) =
            bin.face * (base_mgal_[stations_[bin.set_up].number] - zero_mgal);
        column(DayTerm::drift)(i) = seconds_between(middle, bin.time) / kSecondsPerHour;
        column(DayTerm::warm_up)(i) = std::exp(-seconds_between(begin, bin.time) / kSecondsPerHour /
                                               unit::kTypicalUnit.warm_up_h);
        column(DayTerm::x)(i) = bin.face * bin.x.value();
        column(DayTerm::y)(i) = bin.face * bin.y.value();
        const Index place = place_of(stations_[bin.set_up].number);
        if (place >= 0) fixed_(i, place) = bin.face;
        // A shock moves the bias; of a day in one face a step is one of the readings.
        fixed_.row(i)
            .segment(steps_begin(), static_cast<Index>(stations_[bin.set_up].steps))
            .setConstant(has_two_faces_ ? 1.0 : bin.face);
    }
}

double DayRegression::lag_s(const Point& u, DayHyper lag) const {
    const auto place = static_cast<Index>(lag);
    return std::exp(priors_.mean(place) + priors_.factor(place, kFastLag) * u[kFastLag] +
                    priors_.factor(place, kSlowLag) * u[kSlowLag]);
}

double DayRegression::scale_share(const Point& u) const {
    if (const unit::ScaleShare& share = priors_.scale_share; share.is_measured)
        return share.mean + share.deviation * u[kScaleShare];
    return 0.5 * std::erfc(-u[kScaleShare] / std::numbers::sqrt2);
}

double DayRegression::scale_share_error(const Point& u, const Point& errors) const {
    Point more = u, less = u;
    more[kScaleShare] += errors[kScaleShare];
    less[kScaleShare] -= errors[kScaleShare];
    return 0.5 * (scale_share(more) - scale_share(less));
}

Eigen::VectorXd DayRegression::on_scale_sd() const {
    Eigen::VectorXd deviations(on_scale());
    for (Index k = 0; k < on_scale(); ++k) {
        const Index place = DayPriors::place_of(kOnScale.at(static_cast<std::size_t>(k)));
        deviations(k) = priors_.share_spread *
                        std::hypot(priors_.mean(place), priors_.factor.row(place).norm());
    }
    return deviations;
}

std::array<Eigen::VectorXd, 2> DayRegression::lag_effects(const Point& u) const {
    const double fast_lag_s = lag_s(u, kFastLag);
    auto columns = temperature_->behind({fast_lag_s, lag_s(u, kSlowLag)});
    for (Eigen::VectorXd& column : columns) column.array() -= unit::kTypicalUnit.set_point_degc;
    columns[0] = (fixed_.col(static_cast<Index>(DayTerm::level)) - columns[0]) *
                 (kSecondsPerHour / fast_lag_s);
    return columns;
}

Eigen::MatrixXd DayRegression::outer_columns(const Point& u) const {
    Eigen::MatrixXd columns(readings_mgal_.size(), kOuterSlopes);
    columns << means().of(record_.outer->values()),
        means().of(unit::lagged(*record_.outer, kOuterLag_s.at(u[kOuterLag])));
    return columns.rowwise() - columns.colwise().mean();
}

Eigen::MatrixXd DayRegression::design(const Point& u) const {
    Eigen::MatrixXd columns = fixed_;
    const auto [fast, slow] = lag_effects(u);
    columns.col(static_cast<Index>(DayTerm::fast)) = fast;
    columns.col(static_cast<Index>(DayTerm::slow)) = slow;
    for (std::size_t k = 0; k < states_.size(); ++k)
        for (const DayHyper lag : {kFastLag, kSlowLag}) {
            auto column =
                columns.col(states_begin() + 2 * static_cast<Index>(k) + static_cast<Index>(lag));
            for (Index i = 0; i < column.size(); ++i)
                column(i) = remaining(record_.bins[static_cast<std::size_t>(i)], states_[k].from,
                                      lag_s(u, lag));
        }
    if (has_outer()) columns.middleCols(outer_begin(), kOuterSlopes) = outer_columns(u);
    for (Index k = 0; k < on_scale(); ++k)
        columns.col(on_scale_begin() + k) =
            (faces_.array() - 1.0) *
            columns.col(static_cast<Index>(kOnScale.at(static_cast<std::size_t>(k)))).array();
    return columns;
}

DayPriors::Matrix DayRegression::prior_factor(const Point& u) const {
    DayPriors::Matrix factor = priors_.factor_in(has_two_faces_);
    for (const DayTerm axis : {DayTerm::x, DayTerm::y})
        factor.row(DayPriors::place_of(axis)) *= std::pow(priors_.bias_factor, u[kBiasSize]);
    return factor;
}

Eigen::VectorXd DayRegression::unscaled(const Point& u, const Eigen::VectorXd& scaled) const {
    Eigen::VectorXd all(estimated() + kLags);
    all << scaled, u[kFastLag], u[kSlowLag];
    Eigen::VectorXd values = unscaling(u) * all;
    values.head(kTerms) += priors_.mean.tail<kTerms>();
    for (Index k = 0; k < on_scale(); ++k)
        values(on_scale_begin() + k) +=
            scale_share(u) *
            priors_.mean(DayPriors::place_of(kOnScale.at(static_cast<std::size_t>(k))));
    return values;
}

Eigen::MatrixXd DayRegression::unscaling(const Point& u) const {
    const DayPriors::Matrix factor = prior_factor(u);
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(estimated(), estimated() + kLags);
    derivative.topLeftCorner(kTerms, kTerms) = factor.bottomRightCorner<kTerms, kTerms>();
    derivative.diagonal().segment(kTerms, gravity_sd_mgal_.size()) = gravity_sd_mgal_;
    derivative.diagonal().segment(states_begin(), states_sd_mgal_.size()) = states_sd_mgal_;
    derivative.diagonal()
        .segment(outer_begin(), on_scale_begin() - outer_begin())
        .setConstant(kOuterSize_mgal_per_degc.at(u[kOuterSize]));
    derivative.topRightCorner(kTerms, kLags) = factor.bottomLeftCorner<kTerms, kLags>();
    const Eigen::VectorXd deviations = on_scale_sd();
    for (Index k = 0; k < on_scale(); ++k) {
        const Index part = on_scale_begin() + k;
        derivative.row(part) =
            scale_share(u) *
            derivative.row(static_cast<Index>(kOnScale.at(static_cast<std::size_t>(k))));
        derivative(part, part) = deviations(k);
    }
    return derivative;
}

DayNoise DayRegression::noise(const Point& u) const {
    // Two independent flickers whose amplitudes are as the shares of the scale and of the bias.
    const double scale = std::pow(scale_share(u), 2), bias = std::pow(1.0 - scale_share(u), 2);
    return {priors_.placement_mgal.at(u[kPlacement]), kFlickerPrior_mgal.at(u[kFlicker]),
            white_mgal_.at(u[kWhite]), has_two_faces_ ? scale / (scale + bias) : 0.0};
}

DayRegression::Point DayRegression::point_of(const DayNoise& noise) const {
    Point u{};
    u[kPlacement] = priors_.placement_mgal.place_of(noise.placement_mgal);
    u[kFlicker] = kFlickerPrior_mgal.place_of(noise.flicker_mgal);
    u[kWhite] = white_mgal_.place_of(noise.white_mgal);
    return u;
}

double DayRegression::log_factor(DayHyper part) const {
    switch (part) {
        case kPlacement:
            return std::log(priors_.placement_mgal.factor);
        case kFlicker:
            return std::log(kFlickerPrior_mgal.factor);
        case kWhite:
            return std::log(kWhiteFactor);
        case kBiasSize:
            return std::log(priors_.bias_factor);
        case kOuterSize:
            return std::log(kOuterSize_mgal_per_degc.factor);
        default:
            return 0.0;
    }
}

Eigen::MatrixXd DayRegression::scaled(const Point& u) const {
    const Eigen::MatrixXd x = design(u);
    Eigen::MatrixXd columns(x.rows(), x.cols() + 1);
    columns.col(0) = readings_mgal_ - x * unscaled(u, Eigen::VectorXd::Zero(estimated()));
    Eigen::MatrixXd terms = x.leftCols(kTerms);
    for (Index k = 0; k < on_scale(); ++k)
        terms.col(static_cast<Index>(kOnScale.at(static_cast<std::size_t>(k)))) +=
            scale_share(u) * x.col(on_scale_begin() + k);
    // Most of the factor is 0: the product of the matrices takes nearly three times the instructions.
    const DayPriors::Matrix factor = prior_factor(u);
    columns.middleCols(1, kTerms).setZero();
    for (Index k = 0; k < kTerms; ++k)
        for (Index j = 0; j < kTerms; ++j)
            if (const double share = factor(kLags + j, kLags + k); share != 0.0)
                columns.col(1 + k) += share * terms.col(j);
    columns.middleCols(1 + kTerms, gravity_sd_mgal_.size()) =
        x.middleCols(kTerms, gravity_sd_mgal_.size()) * gravity_sd_mgal_.asDiagonal();
    columns.middleCols(1 + states_begin(), states_sd_mgal_.size()) =
        x.middleCols(states_begin(), states_sd_mgal_.size()) * states_sd_mgal_.asDiagonal();
    const Index outer = on_scale_begin() - outer_begin();
    columns.middleCols(1 + outer_begin(), outer) =
        kOuterSize_mgal_per_degc.at(u[kOuterSize]) * x.middleCols(outer_begin(), outer);
    columns.rightCols(on_scale()) = x.rightCols(on_scale()) * on_scale_sd().asDiagonal();
    return columns;
}

Eigen::MatrixXd DayRegression::lag_columns(const Point& u, const Eigen::VectorXd& values) const {
    constexpr double kStep = 0.1;
    const auto slope = [&](DayTerm term) -> Eigen::VectorXd {
        Eigen::VectorXd of =
            Eigen::VectorXd::Constant(faces_.size(), values(static_cast<Index>(term)));
        for (Index k = 0; k < on_scale(); ++k)
            if (kOnScale.at(static_cast<std::size_t>(k)) == term)
                of.array() += values(on_scale_begin() + k) * (faces_.array() - 1.0);
        return of;
    };
    const auto lagged_effects = [&](const Point& at) -> Eigen::VectorXd {
        const auto [fast, slow] = lag_effects(at);
        return slope(DayTerm::fast).cwiseProduct(fast) + slope(DayTerm::slow).cwiseProduct(slow);
    };
    Eigen::MatrixXd columns = design(u) * unscaling(u).rightCols(kLags);
    for (const DayHyper lag : {kFastLag, kSlowLag}) {
        Point more = u, less = u;
        more.at(lag) += kStep;
        less.at(lag) -= kStep;
        columns.col(static_cast<Index>(lag)) +=
            (lagged_effects(more) - lagged_effects(less)) / (2.0 * kStep);
    }
    return columns;
}

std::optional<OuterResponse> DayRegression::outer_response(const Point& u,
                                                           const Eigen::VectorXd& values,
                                                           const Eigen::VectorXd& errors) const {
    if (!has_outer()) return std::nullopt;
    const Index level = outer_begin(), slow = level + 1;
    return OuterResponse{{{{values(level), errors(level)}, {values(slow), errors(slow)}}},
                         kOuterLag_s.at(u[kOuterLag])};
}

}  // namespace a351::corrector::whole_day
