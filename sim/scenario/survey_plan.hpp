#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"

namespace a351::sim::scenario {

/// One set-up of the box at a site, with its drawn times.  A stay has one or several set-ups.
struct PlannedSetUp {
    text::Site site;  ///< With the true gravity.
    int number = 1;   ///< Number of the stay at this site.
    int part = 1;     ///< Counts the set-ups of the stay.
    int parts = 1;
    UtcTime start;
    UtcTime end;
    bool is_outlier = false;
    /// Instant from which its gravity and levelling apply: halfway through the drive to the site
    /// (the start of the record for the first), or the start of a further set-up of the stay.
    UtcTime from;
    double about_y_rad = 0.0;  ///< Levelling, first turn.
    double about_x_rad = 0.0;  ///< Levelling, second turn; half a turn more in the other face.
    double face = 1.0;         ///< 1, or -1 if the sensor is turned over.
    double placement_mgal = 0.0;
    double step_mgal = 0.0;   ///< Change of the reading by the drives so far.
    bool is_occupied = true;  ///< False for the one set-up of a record without occupations.
};

/// Draws start and length of every occupation, and levelling and placement of every set-up.
/// Set-ups keep their order, do not overlap and lie within the record.
/// @return at least one set-up.
[[nodiscard]] std::vector<PlannedSetUp> plan_survey(const Scenario& scenario, std::uint64_t seed);

/// Returns the temperature error of the simulated unit: the scenario's, drawn within its scatter.
[[nodiscard]] plant::TemperatureErrorParameters drawn_unit(const Scenario& scenario,
                                                           std::uint64_t seed);

/// Returns the table site,longitude_deg,latitude_deg,altitude_m,gravity_mgal.
[[nodiscard]] std::string sites_csv(const Scenario& scenario);

/// Returns the table site,occupation,start_utc,end_utc,used,note with a row per set-up.  `used` is
/// 0 for the occupations that the publication left out.
[[nodiscard]] std::string schedule_csv(const std::vector<PlannedSetUp>& plan);

/// Writes or replaces a file.  @throws std::system_error  it cannot be written; names the file.
void write_text_file(const std::filesystem::path& file, const std::string& text);

}  // namespace a351::sim::scenario
