#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace a351::daemon::ctl {

/// A stay of the daemon's list.
struct MeantStay {
    std::string key, site;
    std::string text;  ///< One line for the operator, with key and times.
};

/// Returns the stay that is meant when no key is given: the running one, or else the last one in
/// time that was not discarded; std::nullopt if there is neither.
/// @param status       answer of GET /api/status.
/// @param occupations  answer of GET /api/occupations.
[[nodiscard]] std::optional<MeantStay> meant_stay(const nlohmann::json& status,
                                                  const nlohmann::json& occupations);

}  // namespace a351::daemon::ctl
