#pragma once

#include <cstdint>
#include <filesystem>

#include "sim/scenario/scenario.hpp"

namespace a351::sim {

/// Writes sites.csv, schedule.csv and truth.csv of a simulated day into `directory`, which is made
/// if it does not exist.  Without occupations, schedule and truth have no rows.
/// @throws InputError         the occupations do not fit into the record; nothing is written.
/// @throws std::system_error  a file cannot be written.
void write_plan(const Scenario& scenario, std::uint64_t seed,
                const std::filesystem::path& directory);

/// Returns true if occupations are at two sites or more.  At a single site gravity does not change,
/// and a fitted model would be meaningless.
[[nodiscard]] bool has_two_sites(const Scenario& scenario);

/// Writes survey.toml, with which a351-correct corrects the day from the tables of write_plan().
/// @throws std::system_error  the file cannot be written.
void write_survey_file(const Scenario& scenario, const std::filesystem::path& directory);

}  // namespace a351::sim
