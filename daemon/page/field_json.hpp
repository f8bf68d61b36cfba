#pragma once
/// @file
/// The information for the operator at a benchmark, as JSON.  A number that is not known is null.

#include <nlohmann/json_fwd.hpp>

#include "daemon/survey/field_status.hpp"

namespace a351::daemon {

[[nodiscard]] nlohmann::json to_json(const Verdict& verdict, UtcTime now);
[[nodiscard]] nlohmann::json to_json(const OccupationReading& reading);
[[nodiscard]] nlohmann::json to_json(const RunningReading& reading, MilliGal target);

/// Returns the tilt relative to the day's first set-up; null if there was none.
[[nodiscard]] nlohmann::json tilt_of(const FieldStatus& field);

/// Returns the scale of each channel of the live stream: value = offset + scale x counts.
[[nodiscard]] nlohmann::json channels_of(const LiveRecord& live);

}  // namespace a351::daemon
