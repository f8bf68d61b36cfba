#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace a351::daemon::ctl {

/// Returns the answer of GET /api/survey for people: what is wrong with the day, the stays as a
/// table, their remarks, and from when the figures are.
[[nodiscard]] std::string survey_text(const nlohmann::json& answer);

/// Returns the gravity of the newest stay that has one, and the first finding that is certain, in one
/// line; empty if there are none.
[[nodiscard]] std::string newest_gravity(const nlohmann::json& answer);

}  // namespace a351::daemon::ctl
