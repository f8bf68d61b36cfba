#pragma once

#include <cstdint>
#include <filesystem>

#include "protocol/wire/device_profile.hpp"
#include "sim/device/register_machine.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim {

struct DirectSurvey {
    std::int64_t frames = 0;
    std::int64_t records = 0;  ///< miniSEED records written.
};

/// Writes a simulated day to a data root as the daemon would have: journal, archive, metadata,
/// events; beside them sites.csv, schedule.csv, survey.toml and the truth (truth.csv, truth.bin).
/// The frames arrive without any delay beyond the device's own.  Without occupations at two sites
/// there is nothing to survey, and no survey.toml.
///
/// The day is written to `partial` in `root` and moved up when it is whole; a failure removes it.
///
/// @throws InputError         `root` already holds a file or directory of a day, or `partial` of
///                            one that was killed; the occupations do not fit into the record.
/// @throws std::system_error  a file cannot be written.
DirectSurvey write_survey(const Scenario& scenario, const wire::DeviceProfile& profile,
                          std::uint64_t seed, const std::filesystem::path& root);

}  // namespace a351::sim
