#pragma once
/// @file
/// A long record corrected with a calibration, in two ways
/// (corrector/long_record/long_record.md, "Applying a calibration").

#include <string>
#include <vector>

#include "corrector/long_record/record_analysis.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

/// Of one series: as it was, corrected with two paths, corrected mode by mode.
struct ThreeWays {
    double before = 0.0, parametric = 0.0, by_modes = 0.0;
};

/// Scatter about a straight line at periods from the shortest to the longest.
struct BandScatter {
    double shortest_s = 0.0, longest_s = 0.0;  ///< The last band's longest is infinite.
    ThreeWays rms_mgal;
};

struct AllanPoint {
    double averaging_s = 0.0;
    ThreeWays deviation_mgal;
};

struct AppliedCalibration {
    std::string origin;                   ///< Of the calibration, in words.
    std::vector<double> parametric_mgal;  ///< (n) of the segment.
    std::vector<double> by_modes_mgal;    ///< (n)
    std::vector<BandScatter> bands;       ///< The fastest first.
    std::vector<AllanPoint> allan;        ///< Averages of 1, 2, 4 ... samples up to n / 4.
    double averaged_below_s = 0.0;        ///< Modes of the acceleration that are averaged away.
    std::vector<std::string> remarks;     ///< What of the calibration was not applied, and why.
};

/// The response is that of the calibration beside the fit's wide priors; its static part (rA and rS) and
/// its fast part are applied where twice their error leaves them a sign.
///
/// Parametric: the two paths on the temperature, which a local parabola over 5 min smooths before.
/// Mode by mode: every mode of the temperature with a period of `averaged_below_s` or more is turned and
/// scaled by the response at its mean period, the residue by the static slope; modes of the acceleration
/// with shorter periods are left out, as an average over them would do.
/// @param analysis  of this segment.
[[nodiscard]] AppliedCalibration apply_calibration(const ThermalResponse& thermal,
                                                   const RecordSegment& segment,
                                                   const RecordAnalysis& analysis,
                                                   double averaged_below_s);

/// Overlapping, of averages over `samples` neighbours.
/// @param values  (n), n >= 2 samples, samples >= 1.
/// Source: D. W. Allan, Proc. IEEE 54, 221-230, 1966; overlapping: W. J. Riley, NIST SP 1065, 2008, 5.2.4.
[[nodiscard]] double allan_deviation(const std::vector<double>& values, std::size_t samples);

}  // namespace a351::corrector
