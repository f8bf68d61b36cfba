#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace a351::daemon::ctl {

/// Returns the answer of GET /api/rows as one screen of text.
/// Control characters in names and notes are shown as "?", because the terminal would execute them.
[[nodiscard]] std::string status_screen(const nlohmann::json& answer, bool is_coloured);

/// Return the answers of GET /api/sites and GET /api/occupations as tables.
[[nodiscard]] std::string site_table(const nlohmann::json& answer);
[[nodiscard]] std::string occupation_table(const nlohmann::json& answer);

/// Returns the exit status of a monitoring plugin: 0 good, 1 warning, 2 fault, 3 unknown level.
[[nodiscard]] int plugin_status(const nlohmann::json& answer);

/// Replaces control characters by "?".
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace a351::daemon::ctl
