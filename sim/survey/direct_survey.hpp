#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "protocol/wire/device_profile.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim::survey {

struct DirectSurvey {
    std::int64_t frames = 0;
    std::int64_t records = 0;  ///< miniSEED records written.
};

/// Writes a simulated day to a data root as the daemon would: journal, archive, metadata, events.
/// Also writes sites.csv, schedule.csv, survey.toml and the truth (truth.csv, truth.bin).
/// Frames are delayed by the device and by the scenario's line, without its is_bytewise and
/// is_paced.  Without occupations at two sites or more survey.toml is not written.
///
/// The day is written to `partial` in `root` and moved up when complete; a failure removes it.
///
/// @throws InputError         `root` already holds a file or directory of a day, or `partial` of a
///                            killed run; the occupations do not fit into the record.
/// @throws std::system_error  a file cannot be written.
DirectSurvey write_survey(const scenario::Scenario& scenario, const wire::DeviceProfile& profile,
                          std::uint64_t seed, const std::filesystem::path& root,
                          const std::string& serial_number = "00000001");

/// Writes sites.csv, schedule.csv and truth.csv of a simulated day into `directory`, which is made
/// if it does not exist.  Without occupations, schedule and truth have no rows.
/// @throws InputError         the occupations do not fit into the record; nothing is written.
/// @throws std::system_error  a file cannot be written.
void write_plan(const scenario::Scenario& scenario, std::uint64_t seed,
                const std::filesystem::path& directory);

}  // namespace a351::sim::survey
