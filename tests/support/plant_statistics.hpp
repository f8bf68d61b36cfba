#pragma once
/// @file
/// Statistics of simulated records, to be compared with the published ones (Matsuda et al.,
/// tests/golden/tsukuba/README.md).  Each figure is the mean over seeds and has an accepted range.
/// The ranges allow for details that the publication does not give and for the scatter of single
/// records.

#include <cstdint>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"

namespace a351::sim {

struct Figure {
    std::string name;       ///< Name with its unit.
    std::string published;  ///< Value as published, or words if the publication has no number.
    double low = 0.0, high = 0.0;
    std::vector<double> values;  ///< One value per seed.

    [[nodiscard]] double mean() const;
    [[nodiscard]] double deviation() const;  ///< Standard deviation of the single values.
    [[nodiscard]] bool is_accepted() const { return mean() >= low && mean() <= high; }
};

/// Means over one occupation without its first and last minute, which handling disturbs.
struct DayRow {
    double temperature_degc = 0.0;
    double difference_mgal = 0.0;  ///< Reading minus gravity minus tide.
    double middle_h = 0.0;         ///< Middle of the occupation since the start of the record.
};
[[nodiscard]] std::vector<DayRow> survey_day(const scenario::Scenario& scenario,
                                             std::uint64_t seed);

/// Means over 20 s of a record at one point.
struct IndoorRecord {
    static constexpr double kStepSeconds = 20.0;
    std::vector<double> temperature_degc;
    std::vector<double> difference_mgal;
};
[[nodiscard]] IndoorRecord indoor_record(const scenario::Scenario& scenario, std::uint64_t seed);

/// Returns figures for seeds 1 ... `seeds` of the scenario tsukuba, from samples at whole seconds
/// only.
[[nodiscard]] std::vector<Figure> survey_day_figures(int seeds);

/// Returns figures for seeds 1 ... `seeds` of the scenario indoor.
[[nodiscard]] std::vector<Figure> indoor_figures(int seeds);

/// Returns figures of the same records decomposed by EEMD: 10 modes, 60 members.
[[nodiscard]] std::vector<Figure> indoor_eemd_figures(int seeds);

}  // namespace a351::sim
