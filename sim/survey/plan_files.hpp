#pragma once

#include <cstdint>
#include <filesystem>

#include "sim/scenario/scenario.hpp"

namespace a351::sim {

/// Writes sites.csv, schedule.csv and truth.csv of a simulated day into `directory`, which it makes
/// if need be.  A record without occupations has a schedule and a truth without rows.
/// @throws InputError         the occupations do not fit into the record; nothing is written.
/// @throws std::system_error  a file cannot be written.
void write_plan(const Scenario& scenario, std::uint64_t seed,
                const std::filesystem::path& directory);

/// Whether occupations were made at two sites or more: at one, gravity does not change, and a model
/// fitted to it would mean nothing.
[[nodiscard]] bool has_two_sites(const Scenario& scenario);

/// Writes survey.toml, which has a day corrected by the tables of write_plan().
/// @throws std::system_error  the file cannot be written.
void write_survey_file(const Scenario& scenario, const std::filesystem::path& directory);

}  // namespace a351::sim
