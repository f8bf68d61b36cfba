#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "daemon/status/status.hpp"
#include "daemon/survey/field_status.hpp"
#include "daemon/survey/occupations.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::page {

/// Version of the interface, published as `api`; increased when a field changes its meaning.
inline constexpr int kApiVersion = 1;

[[nodiscard]] std::string_view to_text(status::Status::Level level) noexcept;

/// Returns the body of GET /api/status.  A number that is not known or not finite is null.
/// @param stale_after  the verdict is "no data" if the last sample is older than this.
[[nodiscard]] nlohmann::json to_json(const status::Status& status,
                                     const survey::Occupations& occupations,
                                     const survey::FieldStatus& field, const live::Record& live,
                                     Nanoseconds stale_after);

/// Converts the running occupation; `now` gives its running time.
[[nodiscard]] nlohmann::json to_json(const events::RunningOccupation& running, UtcTime now);
[[nodiscard]] nlohmann::json to_json(const events::Occupation& occupation);
[[nodiscard]] nlohmann::json to_json(const survey::SiteDistance& one);

/// Convert the information for the operator at a benchmark.  A number that is not known is null.
[[nodiscard]] nlohmann::json to_json(const verdict::Verdict& verdict, UtcTime now);
[[nodiscard]] nlohmann::json to_json(const verdict::RunningReading& reading, MilliGal target);
/// Converts the mean alone, for a stay that has ended.
[[nodiscard]] nlohmann::json mean_of(const verdict::RunningReading& reading);

/// Returns the tilt relative to the day's first set-up; null if there was none.
[[nodiscard]] nlohmann::json tilt_of(const survey::FieldStatus& field);

/// Returns the scale of each channel of the live stream: value = offset + scale x counts.
[[nodiscard]] nlohmann::json channels_of(const live::Record& live);

}  // namespace a351::daemon::page
