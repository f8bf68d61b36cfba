#pragma once
/// @file
/// The noise of a record at one point: spectrum, Allan deviation, a model of three noises, and how
/// long a stay gains from a longer average.
///
///     const RecordNoise noise = record_noise(segment.acceleration_mgal, step_s);
///     if (noise.useful) noise.useful->averaging_s;  // a longer average scatters hardly less

#include <cstddef>
#include <optional>
#include <vector>

namespace a351::corrector::long_record {

/// Power spectral density in a third of an octave; one-sided, of the record without a straight line.
struct NoiseBand {
    double period_s = 0.0;  ///< Period of the mean frequency.
    double density_mgal2_per_hz = 0.0;
};

/// Allan deviation of averages over one time, as measured and by the model.
struct AllanDeviation {
    double averaging_s = 0.0;
    double deviation_mgal = 0.0;
    double model_mgal = 0.0;
};

/// Time between two stays that are compared.  Reason: from one station to the next and back it is an
/// hour or more, in which flicker, drift and the cycle of the oven act.
inline constexpr double kBetweenStays_s = 3600.0;

/// Scatter of averages kBetweenStays_s apart: the rms of their differences, divided by sqrt(2).
struct StayScatter {
    double averaging_s = 0.0;
    double scatter_mgal = 0.0;
};

/// Noise of a record.
///
/// The three noises make the Allan variance
///
///     sigma^2(t) = white^2 / t + (2 ln 2 / pi) flicker^2 + walk^2 t / 3
///
/// A drift or a cycle of the oven is not noise, but raises the deviation at its times too.
struct RecordNoise {
    std::vector<NoiseBand> spectrum;    ///< The shortest period first.
    std::vector<AllanDeviation> allan;  ///< Averages of 1, 2, 4 ... samples up to n / 4.
    double white_mgal_sqrt_s = 0.0;     ///< Deviation of an average of 1 s.
    double flicker_mgal = 0.0;
    double walk_mgal_per_sqrt_s = 0.0;
    /// Averages of 1, 2, 4 ... samples up to kBetweenStays_s; empty for a record shorter than three
    /// times that.
    std::vector<StayScatter> stays;
    /// Shortest of these times whose scatter is within a tenth of the least; absent without them.
    std::optional<StayScatter> useful;
};

/// Computes the noise of a record.
///
/// The noises are not negative.  They are fitted by least squares to the ratio of model and measured
/// variance, weighted by the number of independent averages.
///
/// Accuracy (record_noise_test.cpp): 20 000 samples of white noise give its level within 3 %, a
/// spectrum within 20 % in every band, and neither flicker nor walk above 3 % of a sample; a random
/// walk gives its level within 15 %.
/// @param values  (n) mGal, finite, n >= 64.
/// @param step_s  time between samples.
/// Source: W. J. Riley, Handbook of Frequency Stability Analysis, NIST SP 1065, 2008; the names of the
/// noises are those of IEEE Std 952-1997, annex C.
[[nodiscard]] RecordNoise record_noise(const std::vector<double>& values, double step_s);

/// Returns the overlapping Allan deviation of averages over m = `samples` neighbours, in the unit
/// of the values:
///
///     sigma^2 = 1/2 mean over i of (y[i + m] - y[i])^2,  y[i] = mean of x[i] ... x[i + m - 1]
///
/// Accuracy: a ramp gives slope x m / sqrt(2), samples of +-1 in turn give sqrt(2) for m = 1 and 0
/// for m = 2 (apply_calibration_test.cpp).
///
/// Cost: O(n), whatever m.  The mean is subtracted first, so that the level of the record costs no
/// digits of the sums.  A NaN gives NaN.
/// @param values   x (n) finite, n >= 2 m.
/// @param samples  m >= 1.
/// Source: D. W. Allan, Proc. IEEE 54, 221-230, 1966; overlapping: W. J. Riley, NIST SP 1065, 2008,
/// 5.2.4.
[[nodiscard]] double allan_deviation(const std::vector<double>& values, std::size_t samples);

}  // namespace a351::corrector::long_record
