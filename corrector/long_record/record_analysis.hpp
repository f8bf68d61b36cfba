#pragma once
/// @file
/// Analysis of one segment of a long record: the publication's statistics, response by period, two
/// paths.
///
///     RecordAnalysisOptions options;
///     options.threads = 4;
///     if (segment.size() >= least_record_length(options.cycle_s, step_s))
///         show(analyse_record(segment, step_s, options).reading);
///
/// Read `reading` and `remarks` first: they say which numbers have a meaning.  The publication's
/// statistics compare a record with the published night.  Use by_spectrum, by_modes and two_paths
/// for conclusions about the unit, because these have confidence limits.

#include <functional>
#include <optional>
#include <vector>

#include "corrector/eemd/eemd.hpp"
#include "corrector/long_record/pair_statistics.hpp"
#include "corrector/long_record/record_segments.hpp"
#include "corrector/long_record/response.hpp"
#include "corrector/long_record/two_path_fit.hpp"
#include "corrector/noise/record_noise.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::long_record {

/// Options of analyse_record().  Cycle, shift and ensemble are those of the publication.
///
/// Range: mode 1 to eemd::default_mode_count(), cycle_s more than 3 steps, shift_s >= 0 and shorter than the segment, ensemble_size and
/// threads >= 1.  The command accepts cycles of 200 to 7200 s and shifts up to a cycle.
struct RecordAnalysisOptions {
    double cycle_s = 900.0;   ///< Cycle of the oven; default: 15 minutes as in the publication.
    double shift_s = 280.0;   ///< Time by which the acceleration is moved, as in the publication.
    int ensemble_size = 160;  ///< Members of the EEMD, as in the publication's record indoors.
    std::uint64_t seed = 1;   ///< Seed of the EEMD.
    std::optional<int> mode;  ///< Number of the mode of both series; absent: that of the cycle.
    int threads = 1;          ///< Number of threads; the result does not depend on it.
    /// Called with the members done and in all, of both decompositions together; in the caller's
    /// thread.  Empty: no reports.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// The mode that was asked for, or that of the oven's cycle: its mean period is nearest to the cycle
/// by ratio, and within an octave.
///
/// A neighbour_share above 0.2 means that the oscillation may be split between two modes; a remark
/// says so then.
struct ChosenMode {
    std::size_t number = 0;  ///< Number of the mode; 1 is the fastest.
    double period_s = 0.0;
    double energy_share = 0.0;     ///< Component::energy_share of the mode.
    double neighbour_share = 0.0;  ///< Variance of the stronger neighbour, divided by its own.
};

/// Results for one segment.
///
/// - `raw`, `trend`: mGal per degC.  The errors of `raw` are for residuals correlated over four
///   cycles, those of `trend` for residuals correlated over a quarter of the segment.
/// - `temperature`, `acceleration`: EEMD of each series, n values per component.  That of the
///   acceleration is of the series minus its first value.
/// - `by_spectrum`, `by_modes`: fastest first; refused points are among them.
/// - `two_paths`: mGal, degC, s; see fit_two_paths().
struct RecordAnalysis {
    double step_s = 0.0;    ///< Time between samples.
    signal::LineFit raw;    ///< Acceleration over temperature, all samples.
    signal::LineFit trend;  ///< Residue of the acceleration over residue of the temperature.
    /// Last minus first value of both residues.
    double temperature_change_degc = 0.0, acceleration_change_mgal = 0.0;
    PairStatistics band;  ///< Butterworth band pass from cycle / 1.5 to cycle x 5 / 3.
    eemd::Result temperature, acceleration;
    std::optional<ChosenMode> temperature_mode, acceleration_mode;  ///< Absent: no such mode.
    std::optional<PairStatistics> modes;               ///< Statistics of both chosen modes.
    std::vector<ResponsePoint> by_spectrum, by_modes;  ///< Response by period, in two ways.
    /// causal_reading() of the band; if no band shows a response above chance, the reason, and the
    /// record that is needed.
    text::Message reading;
    TwoPathFit two_paths;
    noise::RecordNoise noise;                   ///< Noise of the acceleration.
    std::vector<text::Message> remarks;  ///< Doubtful or impossible results, with the reason.
};

/// Analyses a segment (corrector/long_record/long_record.md, "Statistics" to "Two paths").
///
/// The means of the publication's statistics over ten simulated nights are in their published
/// ranges (indoor_record_test.cpp).
///
/// The decompositions take most of the time, in proportion to ensemble_size; threads share the
/// members.  The result depends on the seed, but not on the number of threads.
///
/// A record without a cycle is analysed too; `reading` then refuses to interpret it
/// (indoor_record_test.cpp).  In one night warm-up, drift and slow temperature cannot be separated.
/// @param segment  from divide_record(), finite.
/// @param step_s   time between samples, s.
/// @param options  see RecordAnalysisOptions.
/// @throws std::invalid_argument  if the segment is shorter than eight cycles.
[[nodiscard]] RecordAnalysis analyse_record(const RecordSegment& segment, double step_s,
                                            const RecordAnalysisOptions& options);

/// Returns the least number of samples for analyse_record(): eight cycles, 360 for 900 s at 20 s.
/// The two-path fit needs 540 samples; divide_record() gives no shorter segment by default.
[[nodiscard]] std::size_t least_record_length(double cycle_s, double step_s);

/// Returns the shortest period of the band about a cycle, s: cycle / 1.5, 600 for 900.
[[nodiscard]] constexpr double shortest_of_band_s(double cycle_s) { return cycle_s / 1.5; }
/// Returns the longest period of the band about a cycle, s: cycle x 5 / 3, 1500 for 900.
[[nodiscard]] constexpr double longest_of_band_s(double cycle_s) { return cycle_s * 5.0 / 3.0; }

}  // namespace a351::corrector::long_record
