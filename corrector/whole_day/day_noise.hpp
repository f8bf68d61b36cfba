#pragma once
/// @file
/// The noise of a survey day, and the whitening of correlated readings.
///
/// Bins of one set-up have its placement error in common, and neighbours in time have similar
/// flicker.  After whitening, the rows of least squares are independent:
///
///     const double log_determinant = whiten(bins, noise, columns);  // readings and regressors
///     // now ordinary least squares of columns.col(0) on the others
///
/// The Gaussian likelihood of residuals r is exp(-(log_determinant + |whitened r|^2) / 2), up to a
/// constant.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "corrector/reading/day_record.hpp"

namespace a351::corrector::whole_day {

/// Three independent parts of the noise, as standard deviations in mGal.
///
/// Averaging over a set-up reduces white noise, flicker only a little, and placement not at all.
/// Only further set-ups reduce placement.
struct DayNoise {
    double placement_mgal = 0.0;  ///< Placement: one error per set-up.
    double flicker_mgal = 0.0;  ///< Flicker: 1/f noise over the day, of the instantaneous reading.
    double white_mgal = 0.0;    ///< White noise of a complete bin (kBinSamples samples).
    double flicker_on_scale = 0.0;  ///< Part of the flicker's variance that is of the scale.
};

/// Error by the gradient in the oven after the box was turned over: standard deviation at the turn, mGal,
/// and time constant of its decay, s.  Assumed, because nobody has turned such an oven.
inline constexpr double kTurn_mgal = 1.0, kTurn_s = 300.0;

/// Noise of a unit that nobody has measured.
///
/// Placement and flicker are what the publication's survey day leaves room for
/// (corrector/methods.md, "The whole-day model"); white is its long record's 0.4 mGal per 20 s.
inline constexpr DayNoise kUsualNoise{1.2, 1.2, 0.25};

/// Log-normal prior of a standard deviation: median x factor^u with u normal, of variance 1.
///
/// About two thirds of the probability are between median / factor and median x factor.
struct LogNormalPrior {
    double median = 0.0, factor = 1.0;  ///< Median; factor of one deviation, > 1.
    /// Returns median x factor^u.
    [[nodiscard]] double at(double u) const { return median * std::pow(factor, u); }
    /// Returns the u of a value > 0.
    [[nodiscard]] double place_of(double value) const {
        return std::log(value / median) / std::log(factor);
    }
};

/// Placement of a unit that nobody has measured.
inline constexpr LogNormalPrior kUsualPlacement_mgal{kUsualNoise.placement_mgal, 2.0};

/// Corner periods, s, of the first-order (Ornstein-Uhlenbeck) processes of equal variance whose sum
/// is the flicker.  Reason: steps of sqrt(10) from a bin to half a day; the sum is within 5 % of
/// 1/f from 120 s to 13000 s (day_noise_test.cpp).  The correlation of a process at the lag dt is
/// exp(-2 pi |dt| / period).
inline constexpr std::array<double, 7> kFlickerPeriods_s{40.0,   126.5,   400.0,  1265.0,
                                                         4000.0, 12649.0, 40000.0};

/// Whitens columns: multiplies them by a root of the inverse covariance of the noise, so that the
/// noise of the rows becomes independent and of variance 1.
///
/// Bins are means, so the covariance of bins i and j is
///
///     flicker^2 / 7 sum_k m_ik m_jk exp(-2 pi |t_i - t_j| / P_k),   m_ik = sinh(y_ik) / y_ik
///     flicker^2 / 7 sum_k (2 y_ik - 1 + exp(-2 y_ik)) / (2 y_ik^2)   on the diagonal
///
/// with y_ik = pi length_i / P_k, plus placement^2 within a set-up, plus white^2 kBinSamples /
/// samples on the diagonal.  Bins count times their face: between two faces the flicker has the
/// factor 1 - 2 flicker_on_scale.  Each turn, at the end t of the bin before it, adds to the bins
/// after it kTurn_mgal^2 exp(-(t_i - t) / kTurn_s) exp(-(t_j - t) / kTurn_s), with the means of these
/// over the bins.  A Kalman filter runs over every column; its time is proportional to bins x
/// columns.
///
/// The order of the bins matters, because the filter goes from each bin to the next.  If set-ups
/// are not in order of time, the correlation of the flicker is wrong.  A set-up whose bins are not
/// together gets a placement for each part.  This is not checked.
///
/// Accuracy: agrees with the dense factorisation within 1e-9 of the norm, the determinant's
/// logarithm within 1e-12 of its value; means of simulated flicker have this covariance
/// (day_noise_test.cpp).
/// @param bins     (n) in order of set-up and time, each with at least one sample; they must not
///                 overlap, or the covariance is not that of means.
/// @param noise    standard deviations, >= 0; white > 0, or flicker > 0 and no two bins at one
///                 time.
/// @param columns  (n, c) finite, changed in place; one row per bin.  Each column is whitened
///                 alone; a NaN spreads to the later rows of its column.
/// @return ln det of the covariance, in ln(mGal^2); 0 without bins.
/// Source: A. C. Harvey, Forecasting, Structural Time Series Models and the Kalman Filter,
/// Cambridge 1989, section 3.4 (regression by filtering every column).
double whiten(const std::vector<reading::DayBin>& bins, const DayNoise& noise,
              Eigen::MatrixXd& columns);

/// whiten() for many noises of the same bins: what depends on the bins alone is computed once,
/// 21 exponentials per bin.
class Whitening {
public:
    /// @param bins  as whiten().
    explicit Whitening(const std::vector<reading::DayBin>& bins);

    /// The same as whiten().
    double whiten(const DayNoise& noise, Eigen::MatrixXd& columns) const;

private:
    using Processes = Eigen::Array<double, kFlickerPeriods_s.size(), 1>;
    struct Bin {
        bool is_new_set_up;
        Processes keep;    ///< Decrease of correlation since the bin before.
        Processes factor;  ///< Covariance with an instant outside the bin, before the decrease.
        double within;     ///< Sum of what the variances of means exceed factor^2 by; negative.
        double samples;
        double face;
        double turn_keep = 0.0;      ///< Decrease of the error after a turn since the bin before.
        double turn_variance = 0.0;  ///< What a turn before the bin adds, mGal^2.
        double turn_factor = 0.0;    ///< Mean of this error over the bin / its value in the middle.
    };
    /// @tparam kTwoFaces  false: without the states that only turned days have.
    template <bool kTwoFaces>
    double whiten_states(const DayNoise& noise, Eigen::MatrixXd& columns) const;

    std::vector<Bin> bins_;
    bool has_two_faces_;
};

/// The covariance of the bins that whiten() removes, for many noises of the same bins: what depends on
/// the bins alone is computed once.  The 21 trials of a search for mistakes then need 0.02 of the time.
class NoiseCovariance {
public:
    /// Cost: 7 n^2 / 2 exponentials.
    /// @param bins  (n) as whiten(), kept by reference; in one face their order is free.
    explicit NoiseCovariance(const std::vector<reading::DayBin>& bins);

    /// Returns the covariance (n, n), mGal^2.
    /// @param noise  as whiten().
    [[nodiscard]] Eigen::MatrixXd at(const DayNoise& noise) const;

private:
    const std::vector<reading::DayBin>& bins_;
    Eigen::MatrixXd flicker_;  ///< (n, n) Lower part: sum over processes of variance 1.
    Eigen::MatrixXd turns_;  ///< (n, turns) Standard deviation of the error after each turn, mGal.
};

}  // namespace a351::corrector::whole_day
