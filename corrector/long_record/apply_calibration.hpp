#pragma once
/// @file
/// A long record corrected with a calibration, in two ways
/// (corrector/long_record/long_record.md, "Applying a calibration").
///
/// It shows how much of the scatter of a record the unit's thermal response explains.  Compare both
/// ways in the bands and in the Allan deviations.  With a calibration that was measured from the
/// same record the improvement is in sample.
///
///     const RecordAnalysis analysis = analyse_record(segment, step_s, options);
///     const AppliedCalibration applied = apply_calibration(
///         *calibration.thermal, segment, analysis, longest_of_band_s(options.cycle_s));
///
/// It is not used for a survey: there the calibration is a prior of the whole-day model.

#include <vector>

#include "corrector/long_record/record_analysis.hpp"
#include "protocol/text/message.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::long_record {

/// A number for one series: before correction, corrected by the two paths, corrected mode by mode.
/// The name of the member that holds it has the unit.
struct ThreeWays {
    double before = 0.0, parametric = 0.0, by_modes = 0.0;
};

/// Scatter about a straight line, in a band of periods.
///
/// It is the rms from the spectrum of the whole segment.  The squares of all bands add up to the
/// variance at periods from 39 s on.
struct BandScatter {
    double shortest_s = 0.0, longest_s = 0.0;  ///< Limits of the band; the last has no upper limit.
    ThreeWays rms_mgal;
};

/// Allan deviation for one averaging time: allan_deviation() of the acceleration.
struct AllanPoint {
    double averaging_s = 0.0;
    ThreeWays deviation_mgal;
};

/// A segment of n samples, corrected in two ways.
///
/// apply_calibration() leaves `origin` empty; whoever knows the calibration file fills it in.  A
/// part that the calibration does not determine is left out, and `remarks` has the reason.  If all
/// parts are, parametric_mgal is the acceleration itself (apply_calibration_test.cpp).
struct AppliedCalibration {
    text::Message origin;                 ///< Origin of the calibration, in words.
    std::vector<double> parametric_mgal;  ///< (n) Acceleration, corrected by the two paths.
    std::vector<double> by_modes_mgal;    ///< (n) Acceleration, corrected mode by mode.
    std::vector<BandScatter> bands;       ///< Bands from 39 s on, the fastest first.
    std::vector<AllanPoint> allan;        ///< Averages of 1, 2, 4 ... samples up to n / 4.
    double averaged_below_s = 0.0;        ///< Modes of the acceleration below it are left out.
    std::vector<text::Message> remarks;   ///< Parts that were not applied, with the reason.
};

/// Corrects a segment with a thermal response.
///
/// The response is that of the calibration, combined with the wide priors of fit_two_paths().  Its
/// static part (rA and rS) is applied if |rA + rS| is at least twice its error, its fast part if
/// |rF| is.
///
/// - Parametric: the two paths are computed from the temperature, which is smoothed by a local
///   parabola over 15 samples, and subtracted.
/// - By modes: each mode of the temperature with a mean period of `averaged_below_s` or more is
///   multiplied by the complex response at that period, the residue by rA + rS; their real parts
///   are subtracted.  Modes of the acceleration with shorter periods are left out, which an average
///   over them would do too.
///
/// The temperature without effect is the mean of the segment, so the level of the record is no
/// result.  The lags are in equilibrium at the first sample.  The segment is not changed.
///
/// Accuracy (apply_calibration_test.cpp): of a sine of 1800 s that follows the rate, the two paths
/// leave less than 2 %, the modes less than 25 %.
/// @param thermal           positive definite covariance.
/// @param segment           (n) samples, finite.
/// @param analysis          analysis of this segment.
/// @param averaged_below_s  limit of the periods, s.
/// @throws std::invalid_argument  if the covariance is not positive definite.
[[nodiscard]] AppliedCalibration apply_calibration(const unit::ThermalResponse& thermal,
                                                   const RecordSegment& segment,
                                                   const RecordAnalysis& analysis,
                                                   double averaged_below_s);

}  // namespace a351::corrector::long_record
