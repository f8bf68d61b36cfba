#include "corrector/long_record/two_path_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "corrector/correlation/fourier.hpp"
#include "corrector/correlation/regression.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "corrector/whole_day/search_grid.hpp"
#include "protocol/core/units.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"

namespace a351::corrector::long_record {
namespace {

using Index = Eigen::Index;
/// Lags tF, tS, time tW and lag tO: logarithms of lag / median, in standard deviations of their priors.
/// Without an outer oven the last is 0.
using Lags = std::array<double, 4>;

constexpr double kShortest_s = 240.0;  // at shorter periods the thermometer's noise dominates
constexpr Index kLinear = 5;           // number of linear terms: drift ... slow
constexpr double kDriftDeviation_mgal_per_h = 1.0;  // assumed: the linear drift of a record
constexpr double kWarmUpDeviation_mgal = 60.0;  // more than the warm-up of the typical unit
constexpr double kWarmUpTimeFactor = 1.5;       // assumed: how much the times of units differ
/// Priors of the linear terms, then of the outer oven's slopes, which may be as large as those of the
/// sensor; their means are 0.
constexpr std::array<double, kLinear + 2> kPriorDeviation{
    kDriftDeviation_mgal_per_h,
    kWarmUpDeviation_mgal,
    unit::kRecordSlopeDeviation_mgal_per_degc,
    unit::kRecordFastDeviation_mgal_per_degc_per_h,
    unit::kRecordSlopeDeviation_mgal_per_degc,
    unit::kRecordSlopeDeviation_mgal_per_degc,
    unit::kRecordSlopeDeviation_mgal_per_degc};
constexpr Lags kLagMedian_s{unit::kTypicalUnit.fast_lag_s, unit::kTypicalUnit.slow_lag_s,
                            unit::kTypicalUnit.warm_up_h* kSecondsPerHour,
                            whole_day::kOuterLag_s.median};
constexpr Lags kLagFactor{unit::kRecordLagFactor, unit::kRecordLagFactor, kWarmUpTimeFactor,
                          whole_day::kOuterLag_s.factor};

/// Returns lag k at the point u, s: median x factor^u.
double lag_s(const Lags& u, std::size_t k) {
    return kLagMedian_s[k] * std::pow(kLagFactor[k], u[k]);
}

/// The regression by frequency: series, spectra, noise, and the cost of the lags.
class Problem {
public:
    Problem(const std::vector<double>& temperature, const std::vector<double>& acceleration,
            double step_s, const std::vector<double>& outer)
        : count_(fast_length_within(temperature.size())),
          step_s_(step_s),
          temperature_(
              {}, Hertz(1.0 / step_s),
              {temperature.begin(), temperature.begin() + static_cast<std::ptrdiff_t>(count_)}) {
        if (!outer.empty()) outer_.emplace(UtcTime{}, Hertz(1.0 / step_s), outer);
        frequencies_ =
            std::min(static_cast<Index>(static_cast<double>(count_) * step_s / kShortest_s),
                     static_cast<Index>(count_ / 2));
        readings_ = transformed(
            {acceleration.begin(), acceleration.begin() + static_cast<std::ptrdiff_t>(count_)});
        mean_degc_ = correlation::mean_of(temperature_.values());
        numbers_.resize(count_);
        std::iota(numbers_.begin(), numbers_.end(), 0.0);
        ramp_ = transformed(numbers_);
        set_trust(acceleration);
        noise_ = Eigen::VectorXd::Ones(frequencies_);
        for (Index k = 0; k < frequencies_; ++k) noise_(k) = 1.0 / static_cast<double>(k + 1);
    }

    /// Returns the number of linear columns: kLinear, with an outer oven two more.
    [[nodiscard]] Index linear() const { return kLinear + (outer_ ? 2 : 0); }
    /// Returns the number of lags and times: 3, with an outer oven 4.
    [[nodiscard]] std::size_t lag_count() const { return outer_ ? 4 : 3; }

    /// Returns the model's columns, linear() series of the temperature's length.
    [[nodiscard]] std::vector<std::vector<double>> columns(const TimeSeries<DegC>& temperature,
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

    /// Returns the columns (2 frequencies, linear()), real parts above imaginary parts, scaled to
    /// noise and priors of variance 1.
    [[nodiscard]] Eigen::MatrixXd design(const Lags& u) const {
        const auto all = columns(temperature_, u);
        Eigen::MatrixXd x(2 * frequencies_, linear());
        for (Index k = 0; k < linear(); ++k) {
            const auto place = static_cast<std::size_t>(k);
            Eigen::VectorXd column = transformed(all[place]);
            if (place >= static_cast<std::size_t>(TwoPathTerm::level) && k < kLinear)
                column =
                    trusted(std::move(column), correlation::fit_line(numbers_, all[place]).slope);
            x.col(k) = kPriorDeviation.at(place) * whitened(std::move(column));
        }
        return x;
    }

    /// Returns the acceleration (2 frequencies), scaled to noise of variance 1.
    [[nodiscard]] Eigen::VectorXd readings() const { return whitened(readings_); }

    /// Returns -ln(restricted likelihood x priors) of the lags, up to a constant; infinite if it
    /// overflows.
    [[nodiscard]] double cost(const Lags& u) const {
        const Eigen::MatrixXd x = design(u);
        const Eigen::VectorXd y = readings();
        const linear_algebra::Cholesky factor(linear_algebra::normal_matrix(x));
        if (!factor.is_positive_definite()) return HUGE_VAL;  // overflow
        const Eigen::VectorXd half = factor.half_solve(x.transpose() * y);
        // 2 cost = ln det(X'X + 1) + y'y - |L^-1 X'y|^2 + |u|^2, with L L' = X'X + 1
        double sum = factor.log_determinant() + y.squaredNorm() - half.squaredNorm();
        for (const double value : u) sum += value * value;
        return 0.5 * sum;
    }

    /// Returns the lags of least cost.
    [[nodiscard]] Lags most_likely(const Lags& start, bool is_nearby) const {
        return whole_day::least_cost_point(
            [this](const Lags& u) { return cost(u); }, start, is_nearby,
            {.farthest = 5.0, .first_step = 0.3, .tolerance = 0.01, .most_costs = 120},
            lag_count());
    }

    /// Returns the coefficients, each divided by the standard deviation of its prior:
    /// (X'X + I)^-1 X'y with X = design(u), y = readings().
    [[nodiscard]] Eigen::VectorXd coefficients(const Lags& u) const {
        const Eigen::MatrixXd x = design(u);
        return linear_algebra::Cholesky(linear_algebra::normal_matrix(x))
            .solve(x.transpose() * readings());
    }

    /// Returns the covariance of coefficients and lags, in deviations of their priors: a part of
    /// the priors and a part of the noise.  The order is that of TwoPathTerm, then the outer oven's
    /// slopes and lag.
    [[nodiscard]] Eigen::MatrixXd covariance(const Lags& u, const Eigen::VectorXd& beta) const {
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

    [[nodiscard]] double thermometer_noise() const { return thermometer_noise_; }

    /// Sets the noise from the residuals.
    void update_noise(const Lags& u, const Eigen::VectorXd& beta) {
        const Eigen::VectorXd rest = readings() - design(u) * beta;
        const Eigen::ArrayXd squares =
            rest.head(frequencies_).array().square() + rest.tail(frequencies_).array().square();
        smooth_noise(0.5 * squares * noise_.array());
    }

private:
    static std::size_t fast_length_within(std::size_t n) {
        while (correlation::fast_length(n) != n) --n;
        return n;
    }

    /// Sets the weights of the frequencies: the share of the temperature's power that is not noise.
    ///
    /// Noise of the thermometer in the regressors would flatten the fit, most where the oven hardly
    /// acts.  If the power is less than three times the noise, the weight is 0: noise alone, with
    /// 14 degrees of freedom from seven tapers, exceeds this once in ten thousand frequencies.
    /// Source: R. J. Carroll et al., Measurement Error in Nonlinear Models, 2nd ed., Chapman & Hall
    /// 2006, chap. 4 (regression calibration).
    void set_trust(const std::vector<double>& acceleration) {
        constexpr double kLeastPower = 3.0;
        const ThermometerSpectrum spectrum =
            thermometer_spectrum(temperature_.values(), {acceleration.begin(), count_}, step_s_);
        const Eigen::Map<const Eigen::ArrayXd> power(spectrum.power.data() + 1, frequencies_);
        thermometer_noise_ = spectrum.noise;
        signal_share_ =
            (power < kLeastPower * spectrum.noise).select(0.0, 1.0 - spectrum.noise / power);
    }

    /// Returns a column of the temperature with the weights applied, except to the straight line of
    /// this slope in it: the line leaks into every frequency and is noise in none.
    [[nodiscard]] Eigen::VectorXd trusted(Eigen::VectorXd column, double slope) const {
        column -= slope * ramp_;
        column.head(frequencies_).array() *= signal_share_.array();
        column.tail(frequencies_).array() *= signal_share_.array();
        return column + slope * ramp_;
    }

    /// Returns the spectrum of a series minus its mean (2 frequencies), real above imaginary parts.
    [[nodiscard]] Eigen::VectorXd transformed(const std::vector<double>& values) const {
        const double mean = correlation::mean_of(values);
        std::vector<double> centred = values;
        for (double& value : centred) value -= mean;
        const correlation::Spectrum spectrum = correlation::half_spectrum(centred, centred.size());
        Eigen::VectorXd parts(2 * frequencies_);
        for (Index k = 0; k < frequencies_; ++k) {
            parts(k) = spectrum[static_cast<std::size_t>(k + 1)].real();
            parts(frequencies_ + k) = spectrum[static_cast<std::size_t>(k + 1)].imag();
        }
        return parts;
    }

    /// Returns the covariance that the noise leaves in weighted sums of the whitened frequencies.
    ///
    /// The noise at different frequencies of a record is not independent: its periods do not fit
    /// into the record, so each frequency has a part of the noise of its neighbours.  The columns
    /// of a drift and of a warm-up leak in the same way.  Therefore each sum is written as weights
    /// of the samples, and its variance is the integral of |their spectrum|^2 x noise, on a grid
    /// finer than the record's own frequencies.
    /// @param weights  (2 frequencies, m)
    [[nodiscard]] Eigen::MatrixXd noise_covariance(const Eigen::MatrixXd& weights) const {
        constexpr std::size_t kFiner = 8;
        const std::size_t fine = kFiner * count_;
        const auto half = static_cast<Index>(fine / 2);
        Eigen::MatrixXd parts(2 * half, weights.cols());
        for (Index m = 0; m < weights.cols(); ++m) {
            const correlation::Spectrum spectrum =
                correlation::half_spectrum(series_of(whitened(weights.col(m))), fine);
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

    /// Returns the series whose product with a record is the sum of the parts of the record's
    /// spectrum with these weights (2 frequencies).
    [[nodiscard]] std::vector<double> series_of(const Eigen::VectorXd& weights) const {
        std::vector<double> of_real(count_), of_imaginary(count_), series(count_);
        for (Index k = 0; k < frequencies_; ++k) {
            of_real[static_cast<std::size_t>(k + 1)] = weights(k);
            of_imaginary[static_cast<std::size_t>(k + 1)] = weights(frequencies_ + k);
        }
        const correlation::Spectrum cosines = correlation::half_spectrum(of_real, count_),
                                    sines = correlation::half_spectrum(of_imaginary, count_);
        for (std::size_t t = 0; t < cosines.size(); ++t) {
            series[t] = cosines[t].real() + sines[t].imag();
            if (t > 0) series[count_ - t] = cosines[t].real() - sines[t].imag();
        }
        return series;
    }

    /// Returns the noise between two frequencies; below the first one as 1/f.
    /// @param place  frequency in units of the first one, > 0.
    [[nodiscard]] double noise_at(double place) const {
        if (place <= 1.0) return noise_(0) / place;
        const auto below = std::min(static_cast<Index>(place), frequencies_) - 1;
        const auto above = std::min(below + 1, frequencies_ - 1);
        return std::lerp(noise_(below), noise_(above), place - std::floor(place));
    }

    /// Divides real and imaginary parts by the root of the noise, which is the mean square of each.
    [[nodiscard]] Eigen::VectorXd whitened(Eigen::VectorXd parts) const {
        parts.head(frequencies_).array() /= noise_.array().sqrt();
        parts.tail(frequencies_).array() /= noise_.array().sqrt();
        return parts;
    }

    /// Sets the noise to the power, smoothed in half octaves; the lowest frequencies to at least
    /// 1/f.
    void smooth_noise(const Eigen::VectorXd& power) {
        constexpr Index kLowest = 8;
        constexpr double kBandRatio = std::numbers::sqrt2;  // half an octave
        for (Index first = kLowest; first < frequencies_;) {
            const Index behind = std::min(
                frequencies_,
                std::max(first + 4, static_cast<Index>(kBandRatio * static_cast<double>(first))));
            noise_.segment(first, behind - first)
                .setConstant(power.segment(first, behind - first).mean());
            first = behind;
        }
        const Index lowest = std::min(kLowest, frequencies_);
        const double here = std::max(power.head(lowest).mean(), 1e-300);
        const Index beside = std::min(2 * kLowest, frequencies_ - 1);
        const double level = noise_.segment(lowest, std::max<Index>(beside - lowest, 1)).mean();
        const double middle = 0.5 * static_cast<double>(lowest + beside);
        for (Index k = 0; k < lowest; ++k)
            noise_(k) = std::max(here, level * middle / static_cast<double>(k + 1));
    }

    std::size_t count_;
    double step_s_;
    TimeSeries<DegC> temperature_;
    std::optional<TimeSeries<DegC>> outer_;  ///< Temperature of an outer oven.
    double mean_degc_ = 0.0;
    Index frequencies_ = 0;
    std::vector<double> numbers_;  ///< 0, 1, 2 ...
    Eigen::VectorXd ramp_;         ///< Their spectrum.
    Eigen::VectorXd readings_;
    Eigen::VectorXd noise_;
    double thermometer_noise_ = 0.0;  ///< degC^2, as in ThermometerSpectrum.
    Eigen::VectorXd signal_share_;    ///< Weights of the temperature's frequencies, 0 to 1.
};

/// A parameter in words.
struct Named {
    const char *key, *name, *unit, *needed;
};
constexpr const char* kByDays =
    text::marked("a set point that moves by about 0.1 degC every few hours, for two days or more");
constexpr const char* kFromPowerOn =
    text::marked("a record that begins when the sensor is switched on");
constexpr const char* kByOuterOven =
    text::marked("an outer oven whose set point moves by a degree every few hours");
/// Parameters in the order of TwoPathTerm, then slopes and lag of the outer oven.
constexpr std::array<Named, kTwoPathTerms + 3> kNamed{{
    {"drift_mgal_per_h", text::marked("drift"), "mGal/h", text::marked("a week or more")},
    {"warm_up_mgal", text::marked("warm-up at the start"), "mGal", kFromPowerOn},
    {"level_mgal_per_degc", text::marked("static slope, prompt"), "mGal/degC", kByDays},
    {"fast_mgal_per_degc_per_h", text::marked("fast path"), "mGal/(degC/h)",
     text::marked("a larger temperature swing at periods of 5 to 30 min")},
    {"slow_mgal_per_degc", text::marked("static slope, late"), "mGal/degC", kByDays},
    {"fast_lag_s", text::marked("lag of the fast path"), "s",
     text::marked("a larger temperature swing at periods of 4 to 8 min")},
    {"slow_lag_s", text::marked("lag of the slow path"), "s", kByDays},
    {"warm_up_time_s", text::marked("time constant of the warm-up"), "s", kFromPowerOn},
    {whole_day::kOuterNames[0].data(), text::marked("slope by the outer oven, prompt"), "mGal/degC",
     kByOuterOven},
    {whole_day::kOuterNames[1].data(), text::marked("slope by the outer oven, late"), "mGal/degC",
     kByOuterOven},
    {whole_day::kOuterNames[2].data(), text::marked("lag of the outer oven"), "s", kByOuterOven},
}};

}  // namespace

TwoPathFit fit_two_paths(const std::vector<double>& temperature_degc,
                         const std::vector<double>& acceleration_mgal, double step_s,
                         double cycle_s, const std::vector<double>& outer_degc) {
    Problem problem(temperature_degc, acceleration_mgal, step_s, outer_degc);
    constexpr int kRounds = 4;
    Lags u{};
    Eigen::VectorXd beta = problem.coefficients(u);
    for (int round = 0; round < kRounds; ++round) {
        problem.update_noise(u, beta);
        u = problem.most_likely(u, round > 0);
        beta = problem.coefficients(u);
    }

    TwoPathFit fit;
    const Eigen::MatrixXd scaled = problem.covariance(u, beta);
    Eigen::VectorXd units(static_cast<Index>(kTwoPathTerms));
    for (Index place = 0; place < scaled.rows(); ++place) {
        const auto k = static_cast<std::size_t>(place);
        const bool is_outer = k >= kTwoPathTerms;
        const bool is_lag = is_outer ? place + 1 == scaled.rows() : place >= kLinear;
        const std::size_t lag = is_outer ? 3 : k - static_cast<std::size_t>(kLinear);
        const Index column = is_outer ? place - units.size() + kLinear : place;
        const double one = is_lag ? std::log(kLagFactor.at(lag))
                                  : kPriorDeviation.at(static_cast<std::size_t>(column));
        const double deviation = one * std::sqrt(scaled(place, place));
        const double value = is_lag ? lag_s(u, lag) : one * beta(column);
        const bool is_determined = std::sqrt(scaled(place, place)) < kDeterminedDeviation;
        const Named& named = kNamed.at(k);
        FittedParameter parameter{
            named.key,
            named.name,
            named.unit,
            value,
            is_lag ? value * deviation : deviation,
            is_determined,
            is_determined ? text::Message() : text::marked_message(named.needed)};
        if (is_outer) {
            fit.outer.push_back(std::move(parameter));
            continue;
        }
        units(place) = one;
        fit.parameters.at(k) = std::move(parameter);
    }
    const auto of_terms = scaled.topLeftCorner(units.size(), units.size());
    fit.covariance = units.asDiagonal() * of_terms * units.asDiagonal();
    constexpr auto level = static_cast<Index>(TwoPathTerm::level),
                   slow = static_cast<Index>(TwoPathTerm::slow);
    fit.static_slope = fit[TwoPathTerm::level].value + fit[TwoPathTerm::slow].value;
    fit.static_slope_error = std::sqrt(fit.covariance(level, level) + fit.covariance(slow, slow) +
                                       2.0 * fit.covariance(level, slow));
    const double prior = std::sqrt(units(level) * units(level) + units(slow) * units(slow));
    fit.is_static_slope_determined = fit.static_slope_error < kDeterminedDeviation * prior;

    const TimeSeries<DegC> whole({}, Hertz(1.0 / step_s), temperature_degc);
    const auto columns = problem.columns(whole, u);
    constexpr auto kInner = static_cast<std::size_t>(kLinear);
    fit.residual_mgal = acceleration_mgal;
    for (std::size_t i = 0; i < fit.residual_mgal.size(); ++i)
        for (std::size_t k = 0; k < columns.size(); ++k)
            fit.residual_mgal[i] -=
                columns[k][i] * (k < kInner ? fit.parameters.at(k) : fit.outer[k - kInner]).value;
    const double mean = correlation::mean_of(fit.residual_mgal);
    for (double& value : fit.residual_mgal) value -= mean;
    fit.residual_rms_mgal = std::sqrt(correlation::variance_of(fit.residual_mgal));

    for (ResponsePoint& point : response_by_spectrum(
             temperature_degc, fit.residual_mgal, step_s,
             {.cycle_s = cycle_s, .is_joint = true, .noise_degc2 = problem.thermometer_noise()}))
        if (point.refusal.empty()) fit.unexplained.push_back(std::move(point));
    return fit;
}

}  // namespace a351::corrector::long_record
