#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/live/live_record.hpp"
#include "daemon/status/status.hpp"
#include "daemon/survey/field_status.hpp"
#include "daemon/survey/so_far.hpp"
#include "daemon/verdict/verdict.hpp"
#include "protocol/events/occupations.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::page {

struct Moment;

[[nodiscard]] std::string_view to_text(status::Status::Level level) noexcept;

/// Returns the body of GET /api/status: the fields of status_fields.hpp.  A number that is not known
/// or not finite is null.
[[nodiscard]] nlohmann::json to_json(const Moment& now);

/// Returns the parts of several sentences, from which another program makes a translation.
[[nodiscard]] nlohmann::json parts_of(const std::vector<text::Message>& messages);

/// Converts the running occupation; `now` gives its running time.
[[nodiscard]] nlohmann::json to_json(const events::RunningOccupation& running, UtcTime now);
[[nodiscard]] nlohmann::json to_json(const events::Occupation& occupation);
[[nodiscard]] nlohmann::json to_json(const survey::SiteDistance& one);

/// Convert the information for the operator at a benchmark.  A number that is not known is null.
[[nodiscard]] nlohmann::json checks_of(const verdict::Verdict& verdict);
[[nodiscard]] nlohmann::json to_json(const verdict::RunningReading& reading);
/// Returns the gravity of the stay of a key; null if it is not computed yet.
[[nodiscard]] nlohmann::json gravity_of(const survey::SoFar& so_far, const std::string& key);

/// Returns the scale of each channel of the live stream: value = offset + scale x counts.
[[nodiscard]] nlohmann::json channels_of(const live::Record& live);

}  // namespace a351::daemon::page
