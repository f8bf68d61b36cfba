#pragma once

#include <string>
#include <string_view>

#include "daemon/live/live_record.hpp"

namespace a351::daemon {

/// The body of GET /api/history?channel=x|y|z|temperature|oven&from=UTC&to=UTC&points=N:
///
///     {"channel", "unit", "interval_s", "points": [[t_ms, low, high], ...]}
///
/// Least and largest value from the Unix time t_ms on for interval_s; where nothing was recorded
/// there is no point.  Of the oven: [t_ms, process_value, set_point], null where it is not known,
/// and interval_s is the least distance of two points, 0 for fewer.
/// @param query  points 1 ... 4000, 1000 by default; from and to by default the last 24 h.
/// @throws InputError  naming key, value and what is allowed.
[[nodiscard]] std::string history_json(const LiveRecord& live, std::string_view query, UtcTime now);

}  // namespace a351::daemon
