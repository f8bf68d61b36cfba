#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_model.hpp"
#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::long_record {

/// Lags tF, tS, time tW and lag tO of the two-path model: logarithms of lag / median, in standard
/// deviations of their priors.  Without an outer oven the last is 0.
using TwoPathLags = std::array<double, 4>;

/// Number of linear terms: drift ... slow of TwoPathTerm.
constexpr Eigen::Index kTwoPathLinear = 5;

/// Standard deviations of the priors of the linear terms, in their units and the order of
/// TwoPathTerm, then of the slopes by the outer oven, which may be as large as those of the sensor.
/// Their means are 0.  The drift is assumed; the warm-up is larger than that of the typical unit.
inline constexpr std::array kTwoPathDeviations{1.0,
                                               60.0,
                                               unit::kRecordSlopeDeviation_mgal_per_degc,
                                               unit::kRecordFastDeviation_mgal_per_degc_per_h,
                                               unit::kRecordSlopeDeviation_mgal_per_degc,
                                               unit::kRecordSlopeDeviation_mgal_per_degc,
                                               unit::kRecordSlopeDeviation_mgal_per_degc};

/// Priors of tF, tS, tW and tO.  The factor 1.5 of tW is assumed.
inline constexpr std::array<whole_day::LogNormalPrior, 4> kTwoPathLags_s{
    {{unit::kTypicalUnit.fast_lag_s, unit::kRecordLagFactor},
     {unit::kTypicalUnit.slow_lag_s, unit::kRecordLagFactor},
     {unit::kTypicalUnit.warm_up_h * kSecondsPerHour, 1.5},
     whole_day::kOuterLag_s}};

/// The regression by frequency of a two-path fit: series, spectra, noise, and the cost of the lags.
/// Model, priors, source and accuracy: two_path_fit.hpp.
class TwoPathRegression {
public:
    /// @param temperature   degC.
    /// @param acceleration  mGal, as many samples.
    /// @param step_s        time between samples.
    /// @param outer         temperature of an outer oven, degC, as many samples; empty: none.
    TwoPathRegression(const std::vector<double>& temperature,
                      const std::vector<double>& acceleration, double step_s,
                      const std::vector<double>& outer);

    /// Returns the number of linear columns: kTwoPathLinear, with an outer oven two more.
    [[nodiscard]] Eigen::Index linear() const { return kTwoPathLinear + (outer_ ? 2 : 0); }
    /// Returns the number of lags and times: 3, with an outer oven 4.
    [[nodiscard]] std::size_t lag_count() const { return outer_ ? 4 : 3; }

    /// Returns the model's columns, linear() series of the temperature's length.
    [[nodiscard]] std::vector<std::vector<double>> columns(const TimeSeries<DegC>& temperature,
                                                           const TwoPathLags& u) const;

    /// Returns the columns (2 frequencies, linear()), real parts above imaginary parts, scaled to
    /// noise and priors of variance 1.
    [[nodiscard]] Eigen::MatrixXd design(const TwoPathLags& u) const;

    /// Returns the acceleration (2 frequencies), scaled to noise of variance 1.
    [[nodiscard]] Eigen::VectorXd readings() const { return whitened(readings_); }

    /// Returns -ln(restricted likelihood x priors) of the lags, up to a constant; infinite if it
    /// overflows.
    [[nodiscard]] double cost(const TwoPathLags& u) const;

    /// Returns the lags of least cost.
    [[nodiscard]] TwoPathLags most_likely(const TwoPathLags& start, bool is_nearby) const;

    /// Returns the coefficients, each divided by the standard deviation of its prior:
    /// (X'X + I)^-1 X'y with X = design(u), y = readings().
    [[nodiscard]] Eigen::VectorXd coefficients(const TwoPathLags& u) const;

    /// Returns the covariance of coefficients and lags, in deviations of their priors: a part of
    /// the priors and a part of the noise.  The order is that of TwoPathTerm, then the outer oven's
    /// slopes and lag.
    [[nodiscard]] Eigen::MatrixXd covariance(const TwoPathLags& u,
                                             const Eigen::VectorXd& beta) const;

    [[nodiscard]] double thermometer_noise() const { return thermometer_noise_; }

    /// Sets the noise from the residuals.
    void update_noise(const TwoPathLags& u, const Eigen::VectorXd& beta);

private:
    static std::size_t fast_length_within(std::size_t n);

    /// Sets the weights of the frequencies: the share of the temperature's power that is not noise.
    ///
    /// Noise of the thermometer in the regressors would flatten the fit, most where the oven hardly
    /// acts.  If the power is less than three times the noise, the weight is 0: noise alone, with
    /// 14 degrees of freedom from seven tapers, exceeds this once in ten thousand frequencies.
    /// Source: R. J. Carroll et al., Measurement Error in Nonlinear Models, 2nd ed., Chapman & Hall
    /// 2006, chap. 4 (regression calibration).
    void set_trust(const std::vector<double>& acceleration);

    /// Returns a column of the temperature with the weights applied, except to the straight line of
    /// this slope in it: the line leaks into every frequency and is noise in none.
    [[nodiscard]] Eigen::VectorXd trusted(Eigen::VectorXd column, double slope) const;

    /// Returns the spectrum of a series minus its mean (2 frequencies), real above imaginary parts.
    [[nodiscard]] Eigen::VectorXd transformed(const std::vector<double>& values) const;

    /// Returns the covariance that the noise leaves in weighted sums of the whitened frequencies.
    ///
    /// The noise at different frequencies of a record is not independent: its periods do not fit
    /// into the record, so each frequency has a part of the noise of its neighbours.  The columns
    /// of a drift and of a warm-up leak in the same way.  Therefore each sum is written as weights
    /// of the samples, and its variance is the integral of |their spectrum|^2 x noise, on a grid
    /// finer than the record's own frequencies.
    /// @param weights  (2 frequencies, m)
    [[nodiscard]] Eigen::MatrixXd noise_covariance(const Eigen::MatrixXd& weights) const;

    /// Returns the series whose product with a record is the sum of the parts of the record's
    /// spectrum with these weights (2 frequencies).
    [[nodiscard]] std::vector<double> series_of(const Eigen::VectorXd& weights) const;

    /// Returns the noise between two frequencies; below the first one as 1/f.
    /// @param place  frequency in units of the first one, > 0.
    [[nodiscard]] double noise_at(double place) const;

    /// Divides real and imaginary parts by the root of the noise, which is the mean square of each.
    [[nodiscard]] Eigen::VectorXd whitened(Eigen::VectorXd parts) const;

    /// Sets the noise to the power, smoothed in half octaves; the lowest frequencies to at least
    /// 1/f.
    void smooth_noise(const Eigen::VectorXd& power);

    std::size_t count_;
    double step_s_;
    TimeSeries<DegC> temperature_;
    std::optional<TimeSeries<DegC>> outer_;  ///< Temperature of an outer oven.
    double mean_degc_ = 0.0;
    Eigen::Index frequencies_ = 0;
    std::vector<double> numbers_;  ///< 0, 1, 2 ...
    Eigen::VectorXd ramp_;         ///< Their spectrum.
    Eigen::VectorXd readings_;
    Eigen::VectorXd noise_;
    double thermometer_noise_ = 0.0;  ///< degC^2, as in ThermometerSpectrum.
    Eigen::VectorXd signal_share_;    ///< Weights of the temperature's frequencies, 0 to 1.
};

}  // namespace a351::corrector::long_record
