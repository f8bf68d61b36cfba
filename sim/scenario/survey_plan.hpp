#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"

namespace a351::sim {

/// The box standing at a site, as it takes place in this simulation.  A stay has one or several.
struct PlannedSetUp {
    text::Site site;  ///< Its gravity is the true one.
    int number = 1;   ///< Of the stay at this site.
    int part = 1;     ///< Counts the set-ups of the stay.
    int parts = 1;
    UtcTime start;
    UtcTime end;
    bool is_outlier = false;
    UtcTime from;  ///< It acts from here on: halfway through the drive before, or from its start.
    double about_y_rad = 0.0;  ///< Levelling: turned first ...
    double about_x_rad = 0.0;  ///< ... and then.
    double placement_mgal = 0.0;
    bool is_occupied = true;  ///< False for the one set-up of a record without occupations.
};

/// Draws start and length of every occupation, and levelling and placement of every set-up.  They
/// keep their order, do not overlap and lie within the record.  Not empty.
[[nodiscard]] std::vector<PlannedSetUp> plan_survey(const Scenario& scenario, std::uint64_t seed);

/// The temperature error of the unit at hand: the table's, or drawn within its scatter.
[[nodiscard]] TemperatureErrorParameters drawn_unit(const Scenario& scenario, std::uint64_t seed);

/// site,longitude_deg,latitude_deg,altitude_m,gravity_mgal
[[nodiscard]] std::string sites_csv(const Scenario& scenario);

/// site,occupation,start_utc,end_utc,used,note: a row per set-up.  `used` is 0 for the occupations
/// the publication left out.
[[nodiscard]] std::string schedule_csv(const std::vector<PlannedSetUp>& plan);

/// @throws std::system_error  naming the file.
void write_text_file(const std::filesystem::path& file, const std::string& text);

}  // namespace a351::sim
