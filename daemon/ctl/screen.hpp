#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace a351::daemon {

/// The answer of GET /api/status as one screen of text: lines of at most 80 columns for names of
/// usual length, "-" for what is not known.  Control characters of names and notes are shown as
/// "?", for they come from outside and the terminal would obey them.
[[nodiscard]] std::string status_screen(const nlohmann::json& status, bool is_coloured);

/// GET /api/sites and GET /api/occupations as tables.
[[nodiscard]] std::string site_table(const nlohmann::json& answer);
[[nodiscard]] std::string occupation_table(const nlohmann::json& answer);

/// Status of monitoring plugins: 0 good, 1 warning, 2 fault, 3 no level at all.
[[nodiscard]] int plugin_status(const nlohmann::json& status);

[[nodiscard]] std::string printable(std::string_view text);

}  // namespace a351::daemon
