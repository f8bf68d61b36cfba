#pragma once
/// @file
/// What the operator at a benchmark is told, as JSON.  A number that is not known is null.

#include <nlohmann/json_fwd.hpp>

#include "daemon/survey/field_status.hpp"

namespace a351::daemon {

[[nodiscard]] nlohmann::json to_json(const Verdict& verdict, UtcTime now);
[[nodiscard]] nlohmann::json to_json(const OccupationReading& reading);
[[nodiscard]] nlohmann::json to_json(const RunningReading& reading, MilliGal target);

/// Tilt against the day's first set-up; null unless there was one.
[[nodiscard]] nlohmann::json tilt_of(const FieldStatus& field);

/// The scale of each channel of the live stream: value = offset + scale x counts.
[[nodiscard]] nlohmann::json channels_of(const LiveRecord& live);

}  // namespace a351::daemon
