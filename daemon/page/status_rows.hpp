#pragma once
/// @file
/// The status as rows for people: a heading, and one line of text.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "protocol/text/message.hpp"

namespace a351::daemon::page {

struct Row {
    std::string label;  ///< Heading, a text of the catalogue.
    text::Message text;
    std::string level = {};  ///< "good", "warning" or "fault" if the row is coloured; else empty.
};

/// Returns the sentences of a list of parts, separated by semicolons.
[[nodiscard]] text::Message joined(const nlohmann::json& parts);

/// Returns the rows about recorder and sensor; the first one is the state.  A value that is not
/// known is left out; a row of which no value is known is "-".  A row of which the status has no
/// field is left out too.
/// @param status  the body of GET /api/status.
[[nodiscard]] std::vector<Row> recorder_rows(const nlohmann::json& status);

/// Returns the rows that an operator needs at a benchmark: signal, stay, gravity and tilt.
[[nodiscard]] std::vector<Row> operator_rows(const nlohmann::json& status);

/// Returns the rows as a list of objects with label, text, text_parts and level.
[[nodiscard]] nlohmann::json to_json(const std::vector<Row>& rows);

}  // namespace a351::daemon::page
