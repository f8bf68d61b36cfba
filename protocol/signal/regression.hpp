#pragma once
/// @file
/// Mean, variance, straight line through a series with correlated residuals, and cross-correlation
/// of temperature and acceleration.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::signal {

/// A line y = mean_y + slope (x - mean_x).
struct LineFit {
    double slope = 0.0;                 ///< Unit of y per unit of x.
    double slope_error = 0.0;           ///< Standard error of the slope with correlated residuals.
    double mean_x = 0.0, mean_y = 0.0;  ///< Means of x and y.
    double r2 = 0.0;                    ///< Squared correlation of x and y, 0 to 1.
};

/// Fits a line by least squares: slope = sum dx dy / sum dx^2, with dx and dy about their means.
///
/// The standard error allows for correlated residuals.  With m_i = dx_i x residual_i and the
/// Bartlett weights w_l = 1 - l / (correlated + 1):
///
///     slope_error^2 = (sum m_i^2 + 2 sum_l w_l sum m_i m_(i-l)) / (sum dx^2)^2,  l = 1 ...
///     correlated
///
/// A constant x has slope, slope_error and R2 0; a constant y has R2 0.
/// @param x, y        (n) finite, n >= 3.
/// @param correlated  number of samples over which residuals are correlated; 0: independent.  Lags
///                    above n - 1 do not exist and are left out.
/// Source of the error: W. K. Newey and K. D. West, Econometrica 55, 703-708, 1987.
[[nodiscard]] LineFit fit_line(std::span<const double> x, std::span<const double> y,
                               std::size_t correlated = 0);

/// Returns the series (n) minus its least-squares line over the sample number; its mean is 0.
/// @param values  (n) finite, n >= 3.
[[nodiscard]] std::vector<double> without_line(std::span<const double> values);

/// The strongest correlation of one sign.  A delay is positive if the acceleration follows the
/// temperature.
struct CorrelationPeak {
    double delay_s = 0.0;  ///< Delay of the acceleration, refined by a parabola through three lags.
    double value = 0.0;    ///< Correlation at the top of the parabola, about -1 to 1.
};

/// Correlations by delay.
struct CrossCorrelation {
    std::vector<double> delays_s;  ///< (2 most_lag + 1) Delays, ascending, symmetric about 0.
    std::vector<double> values;    ///< (2 most_lag + 1) Correlations, -1 to 1.
    CorrelationPeak negative;      ///< Least correlation within half_cycle lags of 0.
    CorrelationPeak positive;      ///< Greatest correlation within half_cycle lags of 0.
};

/// Correlates the temperature with the acceleration `lag` steps later, for lags of -most_lag to
/// most_lag:
///
///     r(lag) = sum dT_i da_(i+lag) / sqrt(sum dT_i^2 sum da_(i+lag)^2)
///
/// dT and da are about their means.  Sums and means are over the samples that overlap.  The
/// parabola moves a peak by at most one step.
/// Accuracy: for sines of 900 s at steps of 20 s both peaks are within 1 s
/// (indoor_record_test.cpp).
/// @param temperature   (n) finite, not constant in any overlap; n > most_lag.
/// @param acceleration  (n) likewise, any unit.
/// @param half_cycle    number of lags searched for peaks on either side of 0, >= 2.
/// @param most_lag      more than half_cycle.
/// @param step_s        time between samples, s, > 0.
[[nodiscard]] CrossCorrelation correlate(std::span<const double> temperature,
                                         std::span<const double> acceleration, int half_cycle,
                                         int most_lag, double step_s);

/// Returns the size that the correlation of two independent series exceeds at a lag with a
/// probability of 5 %: kNormal95 times its standard deviation (Bartlett 1935),
///
///     sqrt(sum over k of (1 - |k| / n) rx(k) ry(k) / n),   |k| <= most_lag
///
/// where rx and ry are the autocorrelations.  Two series that oscillate in one narrow band
/// correlate by chance much more often than white ones.  At most 1.
/// @param x, y      (n) finite, not constant; n > most_lag.
/// @param most_lag  lags after which an autocorrelation is taken as zero.
[[nodiscard]] double chance_correlation(std::span<const double> x, std::span<const double> y,
                                        int most_lag);

}  // namespace a351::signal
