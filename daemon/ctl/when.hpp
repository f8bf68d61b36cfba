#pragma once

#include <optional>
#include <string_view>

#include "protocol/core/utc_time.hpp"

namespace a351::daemon::ctl {

/// Forms that parse_when() reads, for messages.
inline constexpr const char* kAllowedWhen =
    "RFC 3339 such as 2026-01-31T09:30:00Z, a local time such as 08:45 or 08:45:30, one of UTC "
    "such "
    "as 23:45Z, or a time ago such as -12min (s, min, h)";

/// Reads an instant as an operator writes it.
///
/// A time of day is the latest such instant up to an hour after `now`, in the host's time zone or UTC.  In
/// the repeated hour at the end of summer time it is the later instant if that is not after `now`.
/// The daemon refuses what is later than its last sample.
/// @param now  the daemon's time.
/// @return std::nullopt if the text has none of the forms of kAllowedWhen.
[[nodiscard]] std::optional<UtcTime> parse_when(std::string_view text, UtcTime now);

}  // namespace a351::daemon::ctl
