#pragma once
/// @file
/// One long record as the publication analysed it, and its response by period.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "corrector/eemd/eemd.hpp"
#include "corrector/long_record/pair_statistics.hpp"
#include "corrector/long_record/record_segments.hpp"
#include "corrector/long_record/response.hpp"
#include "corrector/long_record/two_path_fit.hpp"

namespace a351::corrector {

struct RecordAnalysisOptions {
    double cycle_s = 900.0;   ///< Of the oven: the publication's 15 minutes.
    double shift_s = 280.0;   ///< By which the publication moved the acceleration.
    int ensemble_size = 160;  ///< As indoors in the publication.
    std::uint64_t seed = 1;
    int threads = 1;
    /// Called with the members done and in all, of both decompositions.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// The mode that carries the oven's cycle.
struct ChosenMode {
    std::size_t number = 0;  ///< From 1, the fastest.
    double period_s = 0.0;
    double energy_share = 0.0;
    double neighbour_share = 0.0;  ///< Of the stronger neighbour's variance in this one's.
};

struct RecordAnalysis {
    double step_s = 0.0;
    LineFit raw;    ///< Acceleration over temperature, all samples.
    LineFit trend;  ///< Of the residues.
    double temperature_change_degc = 0.0, acceleration_change_mgal = 0.0;  ///< Of the residues.
    PairStatistics band;  ///< Butterworth band pass from cycle / 1.5 to cycle x 5 / 3.
    EemdResult temperature, acceleration;
    std::optional<ChosenMode> temperature_mode, acceleration_mode;
    std::optional<PairStatistics> modes;  ///< Of these two.
    std::vector<ResponsePoint> by_spectrum, by_modes;
    /// causal_reading() of the band, or why the record allows none and what record would.
    std::string reading;
    TwoPathFit two_paths;
    std::vector<std::string> remarks;  ///< What is doubtful, or cannot be shown, and why.
};

/// @param segment  from divide_record().
/// @throws std::invalid_argument  the segment is shorter than eight cycles.
[[nodiscard]] RecordAnalysis analyse_record(const RecordSegment& segment, double step_s,
                                            const RecordAnalysisOptions& options);

/// Fewest samples that analyse_record() takes.
[[nodiscard]] std::size_t least_record_length(double cycle_s, double step_s);

/// Limits of the band about a cycle, seconds: 600 and 1500 of 900, as in the simulation's targets.
[[nodiscard]] double shortest_of_band_s(double cycle_s);
[[nodiscard]] double longest_of_band_s(double cycle_s);

}  // namespace a351::corrector
