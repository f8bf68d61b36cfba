#pragma once

#include <string>
#include <string_view>

#include "daemon/live/live_record.hpp"

namespace a351::daemon::page {

/// Returns the body of GET /api/history?channel=x|y|z|temperature|oven|outer_oven&from=UTC&to=UTC&points=N:
///
///     {"channel", "unit", "interval_s", "points": [[t_ms, low, high], ...]}
///
/// A point has the smallest and largest value from the Unix time t_ms on for interval_s.  There is
/// no point where nothing was recorded.  For an oven a point is [t_ms, process_value, set_point],
/// null if not known, and interval_s is the smallest distance of two points (0 for fewer than two).
/// @param query  points 1 ... 4000, 1000 by default; from and to by default the last 24 h.
/// @throws InputError  with key, value and the allowed values.
[[nodiscard]] std::string history_json(const live::Record& live, std::string_view query,
                                       UtcTime now);

}  // namespace a351::daemon::page
