#include "corrector/whole_day/day_model.hpp"

#include <algorithm>
#include <cmath>

#include "corrector/whole_day/day_problem.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Estimates in the units of the terms.
struct Estimates {
    Eigen::VectorXd values, standard_errors;  ///< (estimated) Terms, then gravities.
    Eigen::VectorXd placement_mgal;           ///< (set-ups) Expectation, given all readings.
};

/// Returns the source of the prior of column k of DayProblem::linearised().
ErrorSource source_of(const DayProblem& problem, Index k) {
    if (k >= problem.states_begin()) return ErrorSource::thermal;  // states, outer oven, lags
    if (k >= kTerms) return ErrorSource::datum;
    switch (static_cast<DayTerm>(k)) {
        case DayTerm::constant:
            return ErrorSource::datum;
        case DayTerm::drift:
        case DayTerm::warm_up:
            return ErrorSource::drift;
        case DayTerm::x:
        case DayTerm::y:
            return ErrorSource::levelling;
        case DayTerm::scale:
            return ErrorSource::scale;
        default:
            return ErrorSource::thermal;
    }
}

/// Sets the gravities with the sources of their errors.
///
/// The error of an estimate is s'(X'e + p): e are the whitened readings' errors and p the priors',
/// all independent and of variance 1.  X is `all`, and s the row of unscaling x covariance.
/// The noise is split with the weights of the readings, W'X s, where W is the whitening.
void set_gravities(const DayProblem& problem, const reading::DayRecord& record,
                   const Estimates& estimates, const Eigen::MatrixXd& unscaling,
                   const Eigen::MatrixXd& all, const Eigen::MatrixXd& covariance, DayFit& fit) {
    const DayNoise noise = problem.noise(fit.expected);
    Eigen::MatrixXd whitening = Eigen::MatrixXd::Identity(all.rows(), all.rows());
    whiten(record.bins, noise, whitening);
    const std::size_t numbers = problem.base_mgal().size();
    for (std::size_t number = 0; number < numbers; ++number) {
        GravityEstimate& gravity = fit.gravity_mgal.emplace_back();
        gravity.of_gravities_mgal.resize(numbers);
        gravity.value = problem.base_mgal()[number];
        const Index place = problem.place_of(number);
        if (place < 0) continue;
        gravity.value += estimates.values(place) / problem.scale(estimates.values);
        gravity.standard_error = estimates.standard_errors(place);
        const Eigen::VectorXd s = unscaling(place, place) * covariance.col(place);
        std::array<double, kErrorSources> squares{};
        const auto square = [&squares](ErrorSource source) -> double& {
            return squares.at(static_cast<std::size_t>(source));
        };
        for (Index k = 0; k < s.size(); ++k) square(source_of(problem, k)) += s(k) * s(k);
        const Eigen::VectorXd whitened = all * s;
        const Eigen::VectorXd weights = whitening.transpose() * whitened;
        std::vector<double> of_set_up(record.bins.back().set_up + 1);
        for (std::size_t i = 0; i < record.bins.size(); ++i) {
            const reading::DayBin& bin = record.bins[i];
            const double weight = weights(static_cast<Index>(i));
            of_set_up[bin.set_up] += weight;
            square(ErrorSource::white) += std::pow(weight * noise.white_mgal, 2) *
                                          static_cast<double>(reading::kBinSamples) /
                                          static_cast<double>(bin.times.size());
        }
        for (const double weight : of_set_up)
            square(ErrorSource::placement) += std::pow(weight * noise.placement_mgal, 2);
        square(ErrorSource::flicker) =
            std::max(0.0, whitened.squaredNorm() - square(ErrorSource::white) -
                              square(ErrorSource::placement));
        std::ranges::transform(squares, gravity.parts_mgal.begin(),
                               [](double value) { return std::sqrt(value); });
        const Index lags = problem.estimated();
        const auto of = [&s](DayTerm term) { return s(static_cast<Index>(term)); };
        gravity.shared_mgal = {s(lags),           s(lags + 1),       of(DayTerm::level),
                               of(DayTerm::slow), of(DayTerm::fast), of(DayTerm::x),
                               of(DayTerm::y),    of(DayTerm::scale)};
        for (std::size_t other = 0; other < numbers; ++other)
            if (const Index at = problem.place_of(other); at >= 0)
                gravity.of_gravities_mgal[other] = s(at);
    }
}

/// Returns values by least squares at the fit's point, and errors with the lags as two more terms
/// and with the expected noise; sets gravities, the response to an outer oven, the shift and its
/// covariance.
Estimates estimate(const DayProblem& problem, const reading::DayRecord& record, std::size_t set_ups,
                   DayFit& fit) {
    const DayFit::Point& u = fit.point;
    const Index estimated = problem.estimated();
    Eigen::MatrixXd columns = problem.scaled(u);
    whiten(record.bins, fit.noise, columns);
    const auto x = columns.rightCols(estimated);
    // (X'X + 1)^-1 X'y: least squares with priors of variance 1
    const Eigen::VectorXd scaled = linear_algebra::Cholesky(linear_algebra::normal_matrix(x))
                                       .solve(x.transpose() * columns.col(0));
    const Eigen::VectorXd left = columns.col(0) - x * scaled;

    Estimates result;
    result.values = problem.unscaled(u, scaled);

    const Eigen::MatrixXd all = problem.linearised(fit.expected, result.values);
    const Eigen::MatrixXd covariance =
        linear_algebra::Cholesky(linear_algebra::normal_matrix(all)).inverse();
    const Eigen::MatrixXd unscaling = problem.unscaling(fit.expected);
    result.standard_errors =
        (unscaling * covariance * unscaling.transpose()).diagonal().cwiseSqrt();
    fit.outer = problem.outer_response(u, result.values, result.standard_errors);
    fit.shift << u[kFastLag], u[kSlowLag], scaled.head(kTerms);
    set_gravities(problem, record, result, unscaling, all, covariance, fit);
    // The lags are last in `covariance` and first in the shift.
    fit.shift_covariance << covariance.bottomRightCorner(kLags, kLags),
        covariance.bottomLeftCorner(kLags, kTerms), covariance.topRightCorner(kTerms, kLags),
        covariance.topLeftCorner(kTerms, kTerms);

    // Expected placement of each set-up: placement^2 M' C^-1 r.  C is the covariance of the noise, r
    // the residuals; M(i, s) = 1 if bin i belongs to set-up s, else 0.
    Eigen::MatrixXd members = Eigen::MatrixXd::Zero(x.rows(), static_cast<Index>(set_ups));
    for (std::size_t i = 0; i < record.bins.size(); ++i)
        members(static_cast<Index>(i), static_cast<Index>(record.bins[i].set_up)) = 1.0;
    whiten(record.bins, fit.noise, members);
    result.placement_mgal =
        fit.noise.placement_mgal * fit.noise.placement_mgal * (members.transpose() * left);
    return result;
}

/// Returns means over the bins of every set-up, weighted by their samples.
std::vector<DaySetUp> means_of_set_ups(const DayProblem& problem, const reading::DayRecord& record,
                                       std::size_t set_ups, const DayProblem::Point& u,
                                       const Eigen::VectorXd& coefficients) {
    std::vector<DaySetUp> means(set_ups);
    std::vector<double> counts(set_ups);
    for (const reading::DayBin& bin : record.bins)
        counts[bin.set_up] += static_cast<double>(bin.times.size());
    const Eigen::MatrixXd x = problem.design(u);
    const Eigen::VectorXd temperature = problem.means().of(record.temperature.series.values());
    for (std::size_t i = 0; i < record.bins.size(); ++i) {
        const reading::DayBin& bin = record.bins[i];
        DaySetUp& mean = means[bin.set_up];
        const auto row = static_cast<Index>(i);
        const double weight = static_cast<double>(bin.times.size()) / counts[bin.set_up];
        mean.reading = mean.reading + MilliGal(weight * problem.readings_mgal()(row));
        mean.tide = mean.tide + MilliGal(weight * bin.tide.value());
        mean.temperature = mean.temperature + DegC(weight * temperature(row));
        mean.rate_degc_per_h += weight * x(row, static_cast<Index>(DayTerm::fast));
        for (std::size_t k = 0; k < kDayTerms; ++k) {
            const auto term = static_cast<Index>(k);
            mean.effect_mgal.at(k) += weight * coefficients(term) * x(row, term);
        }
        for (Index k = problem.steps_begin(); k < problem.states_begin(); ++k)
            mean.effect_mgal.at(static_cast<std::size_t>(DayTerm::drift)) +=
                weight * coefficients(k) * x(row, k);
        // States after gaps are in turn of the fast and of the slow lag.
        for (Index k = problem.states_begin(); k < problem.outer_begin(); ++k) {
            const DayTerm term =
                (k - problem.states_begin()) % 2 == 0 ? DayTerm::fast : DayTerm::slow;
            mean.effect_mgal.at(static_cast<std::size_t>(term)) +=
                weight * coefficients(k) * x(row, k);
        }
        for (Index k = problem.outer_begin(); k < problem.estimated(); ++k)
            mean.effect_mgal.at(static_cast<std::size_t>(DayTerm::slow)) +=
                weight * coefficients(k) * x(row, k);
    }
    return means;
}

/// Returns true if a set-up whose gravity is held has a bin.
bool is_any_held(const reading::DayRecord& record, const std::vector<DayStation>& stations) {
    return std::ranges::any_of(record.bins, [&stations](const reading::DayBin& bin) {
        return stations[bin.set_up].gravity.has_value();
    });
}

/// Returns the fit at a point, with the errors of the expected noise; noise_log_errors is not set.
DayFit fit_at(const DayProblem& problem, const reading::DayRecord& record,
              const std::vector<DayStation>& stations, const DayPriors& priors,
              const DayFit::Point& point, const DayFit::Point& expected) {
    DayFit fit;
    fit.point = point;
    fit.expected = expected;
    fit.noise = problem.noise(point);
    const Estimates estimates = estimate(problem, record, stations.size(), fit);
    fit.fast_lag_s = problem.lag_s(point, kFastLag);
    fit.slow_lag_s = problem.lag_s(point, kSlowLag);
    const DayPriors::Matrix covariance =
        priors.factor * fit.shift_covariance * priors.factor.transpose();
    fit.lag_log_errors = {std::sqrt(covariance(kFastLag, kFastLag)),
                          std::sqrt(covariance(kSlowLag, kSlowLag))};
    for (std::size_t k = 0; k < kDayTerms; ++k) {
        const auto term = static_cast<Index>(k);
        fit.coefficients.at(k) = {estimates.values(term), estimates.standard_errors(term)};
    }
    for (Index k = problem.steps_begin(); k < problem.states_begin(); ++k)
        fit.steps_mgal.push_back({estimates.values(k), estimates.standard_errors(k)});
    fit.set_ups = means_of_set_ups(problem, record, stations.size(), point, estimates.values);
    for (std::size_t s = 0; s < stations.size(); ++s) {
        DaySetUp& set_up = fit.set_ups[s];
        const DayStation& station = stations[s];
        set_up.reading =
            MilliGal(problem.base_mgal()[station.number]) + set_up.reading + set_up.tide;
        set_up.corrected = MilliGal(fit.gravity_mgal[station.number].value +
                                    estimates.placement_mgal(static_cast<Index>(s)));
        // The column of the scale has the rough gravity.
        set_up.effect_mgal.at(static_cast<std::size_t>(DayTerm::scale)) +=
            (problem.scale(estimates.values) - 1.0) *
            (fit.gravity_mgal[station.number].value - problem.base_mgal()[station.number]);
        double effects = 0.0;
        for (const double effect : set_up.effect_mgal) effects += effect;
        set_up.flicker = set_up.reading - set_up.tide - MilliGal(effects) - set_up.corrected;
    }
    return fit;
}

}  // namespace

void DayPriors::observe(const std::vector<Eigen::Index>& places, const Eigen::VectorXd& values,
                        const Eigen::MatrixXd& covariance) {
    const Matrix before = factor * factor.transpose();
    const Eigen::MatrixXd innovation = before(places, places) + covariance;
    const Eigen::MatrixXd gain =
        linear_algebra::Cholesky(innovation).solve(before(places, Eigen::all)).transpose();
    // K = P H' (H P H' + R)^-1
    mean += gain * (values - Eigen::VectorXd(mean(places)));
    // Joseph's form, P = (1 - K H) P (1 - K H)' + K R K': the result remains a covariance, however
    // exact the measurement is.
    Matrix left = Matrix::Identity();
    for (std::size_t k = 0; k < places.size(); ++k)
        left.col(places[k]) -= gain.col(static_cast<Eigen::Index>(k));
    const Matrix after = left * before * left.transpose() + gain * covariance * gain.transpose();
    factor = linear_algebra::Cholesky(0.5 * (after + after.transpose())).lower();
}

void DayPriors::free_axes() {
    // The data sheet's initial bias error is +-2 mg.
    constexpr double kGreatestBias_mgal_per_g = 2000.0;
    for (const Index place : {place_of(DayTerm::x), place_of(DayTerm::y)}) {
        factor.row(place).setZero();
        factor(place, place) = kGreatestBias_mgal_per_g;
    }
    bias_factor = 1.0;
}

void DayPriors::set_scale(double value, double deviation) {
    const Index place = place_of(DayTerm::scale);
    mean(place) = value - 1.0;
    factor.row(place).setZero();
    factor.col(place).setZero();
    factor(place, place) = deviation;
}

// fit_day() lists the priors; corrector/methods.md gives their origin.
DayPriors usual_day_priors() {
    constexpr double kDrift_mgal_per_h = 1.0, kBias_mgal_per_g = 300.0, kBiasFactor = 3.0;
    const unit::ThermalPrior fast_lag = unit::day_prior(unit::ThermalTerm::fast_lag),
                             slow_lag = unit::day_prior(unit::ThermalTerm::slow_lag),
                             level = unit::day_prior(unit::ThermalTerm::level),
                             slow = unit::day_prior(unit::ThermalTerm::slow),
                             fast = unit::day_prior(unit::ThermalTerm::fast);
    DayPriors priors;
    priors.mean << fast_lag.mean, slow_lag.mean, 0.0, level.mean, slow.mean, fast.mean, 0.0, 0.0,
        0.0, 0.0, 0.0;
    DayPriors::Vector deviations;
    deviations << fast_lag.deviation, slow_lag.deviation, kFreeGravity_mgal, level.deviation,
        slow.deviation, fast.deviation, kDrift_mgal_per_h, unit::kTypicalUnit.warm_up_mgal,
        kBias_mgal_per_g, kBias_mgal_per_g, unit::kUsualScaleDeviation;
    priors.factor = deviations.asDiagonal();
    priors.bias_factor = kBiasFactor;
    return priors;
}

std::optional<DayFit> fit_day(const reading::DayRecord& record,
                              const std::vector<DayStation>& stations, const DayFit* nearby,
                              const DayPriors& priors) {
    if (!is_any_held(record, stations)) return std::nullopt;
    const DayProblem problem(record, stations, priors);
    const DayFit::Point point =
        problem.most_likely(nearby != nullptr ? std::optional(nearby->point) : std::nullopt);
    DayFit fit = fit_at(problem, record, stations, priors, point, problem.expected(point));
    fit.noise_log_errors = problem.noise_log_errors(point);
    return fit;
}

std::optional<DayFit> fit_planned_day(reading::DayRecord& record,
                                      const std::vector<DayStation>& stations,
                                      const DayNoise& noise, const DayPriors& priors) {
    if (!is_any_held(record, stations)) return std::nullopt;
    // Nobody knows where the unknown stations are: the scale then has no part in them.
    const MilliGal usual =
        *std::ranges::find_if(stations, [](const DayStation& station) {
             return station.gravity.has_value();
         })->gravity;
    for (reading::DayBin& bin : record.bins)
        bin.reading = bin.tide + stations[bin.set_up].gravity.value_or(usual);
    const DayProblem bare(record, stations, priors);
    const Eigen::VectorXd effects =
        bare.design({}) * bare.unscaled({}, Eigen::VectorXd::Zero(bare.estimated()));
    for (std::size_t i = 0; i < record.bins.size(); ++i) {
        MilliGal& reading = record.bins[i].reading;
        reading = reading + MilliGal(effects(static_cast<Index>(i)));
    }
    const DayProblem problem(record, stations, priors);
    const DayFit::Point point = problem.point_of(noise);
    return fit_at(problem, record, stations, priors, point, point);
}

}  // namespace a351::corrector::whole_day
