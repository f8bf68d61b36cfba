#pragma once
/// @file
/// The tilt of a horizontal axis in a long record, and how it follows the temperature.
///
///     LongRecord tilt = tilt_record(record, 0);
///     RecordSegments parts = divide_record(tilt);
///     TiltFit fit = fit_tilt(parts, tilt.step_s, 0);
///     fit.corrected_urad(tilt.stretches[0].quantity[i], tilt.stretches[0].temperature_degc[i]);

#include <cstddef>

#include "corrector/long_record/record_segments.hpp"
#include "corrector/noise/allan_deviation.hpp"

namespace a351::corrector::long_record {

/// The effect of the temperature on the tilt of an axis.
struct TiltFit {
    std::size_t axis = 0;  ///< 0: x, 1: y.
    double slope_urad_per_degc = 0.0, slope_error_urad_per_degc = 0.0;
    double temperature_degc = 0.0;  ///< Mean temperature, to which tilts are reduced.
    /// Root of the mean square of the residuals, each divided by its expected size.  Above 1 it
    /// increases the error of the slope.
    double misfit = 0.0;
    /// Noise of the corrected tilt in the longest segment, urad in place of mGal.
    noise::AllanAnalysis noise;

    /// Returns the tilt as it would be at the mean temperature.
    [[nodiscard]] double corrected_urad(double tilt_urad, double degc) const {
        return tilt_urad - slope_urad_per_degc * (degc - temperature_degc);
    }
    /// Returns the standard uncertainty of a corrected tilt: scatter of a sample (Allan deviation) and
    /// error of the slope.  The constant bias of the axis and its drift are not in it.
    [[nodiscard]] double u_urad(double degc) const;
};

/// Replaces the norm of a record by the tilt of an axis, urad (archive_series/tilt.hpp), of the
/// decimated axes.  The raw ranges are dropped, and `unit` says which unit the values have.
/// @throws InputError  a stretch has the norm only, or the axis is more than 45 deg from the horizontal
///                     in the median.
[[nodiscard]] LongRecord tilt_record(LongRecord record, std::size_t axis);

/// Fits one slope of the tilt over the temperature for all segments.  Each segment also has its own
/// straight line over time, so that no step or constant rate is taken for an effect of the
/// temperature.
///
///     slope = sum of Re(conj(T_k) a_k) / S_k / sum of |T_k|^2 / S_k
///     u^2 = 35 / 18 / (2 sum of |T_k|^2 / S_k)
///
/// T_k and a_k are the transforms of temperature and tilt under a Hann window, at periods from 240
/// s to the length of the segment (Whittle 1953).  35 / 18 is the loss by the window.  S_k is the
/// noise at these periods: white noise, flicker and random walk that fit the Allan deviation of the
/// corrected tilt.
///
/// A real change of tilt with the temperature, for example of a wall in the sun, cannot be
/// distinguished from an effect on the sensor.
///
/// Accuracy: of 100 records of a day with white noise and random walk the limits of 95 % contain the
/// slope in 90 or more (tilt_record_test.cpp).
/// @param parts   of a record of tilts, with at least one segment.
/// @param step_s  time between samples.
[[nodiscard]] TiltFit fit_tilt(const RecordSegments& parts, double step_s, std::size_t axis);

}  // namespace a351::corrector::long_record
