#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"

namespace a351::sim {

/// One stay at a site as it takes place in this simulation, with its truth.
struct PlannedOccupation {
    text::Site site;  ///< Its gravity is the true one.
    int number = 1;
    UtcTime start;
    UtcTime end;
    bool is_outlier = false;
    UtcTime arrival;  ///< Halfway through the drive before: from here on the site's gravity acts.
};

/// Draws start and length of every occupation; they keep their order and never overlap.
[[nodiscard]] std::vector<PlannedOccupation> plan_survey(const Scenario& scenario,
                                                         std::uint64_t seed);

/// Writes sites.csv, schedule.csv (site,occupation,start_utc,end_utc,used,note) and truth.csv
/// (site,occupation,start_utc,end_utc,gravity_mgal,used) into `directory`, which must exist.
/// `used` is 0 for the occupations the publication left out.
/// @throws std::system_error  a file cannot be written.
void write_plan(const Scenario& scenario, const std::vector<PlannedOccupation>& plan,
                const std::filesystem::path& directory);

/// The three tables as text.
[[nodiscard]] std::string sites_csv(const Scenario& scenario);
[[nodiscard]] std::string schedule_csv(const std::vector<PlannedOccupation>& plan);
[[nodiscard]] std::string truth_csv(const std::vector<PlannedOccupation>& plan);

/// @throws std::system_error  naming the file.
void write_text_file(const std::filesystem::path& file, const std::string& text);

}  // namespace a351::sim
