#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace a351::daemon::ctl {

/// Returns the answer of GET /api/survey for people: the problems of the day, the stays as a
/// table, their remarks, and from when the figures are.
[[nodiscard]] std::string survey_text(const nlohmann::json& answer);

}  // namespace a351::daemon::ctl
