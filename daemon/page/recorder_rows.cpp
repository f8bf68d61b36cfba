#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/page/status_fields.hpp"
#include "daemon/page/status_rows.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;
using text::Message;

/// Counters that also rise without trouble.
constexpr std::string_view kNoTrouble[] = {"bytes",
                                           "frames",
                                           "sessions",
                                           "link_sessions",
                                           "integer_records",
                                           "archive_records",
                                           "archive_records_waiting",
                                           "journal_bytes",
                                           "journal_segments_compressed",
                                           "journal_segments_removed"};

std::string with_blanks(std::string text) {
    std::ranges::replace(text, '_', ' ');
    return text;
}

/// Returns each counter of trouble that is not zero, with its name.
Message troubles(const json& counters) {
    std::string text;
    for (const auto& [name, count] : counters.items()) {
        if (std::ranges::count(kNoTrouble, name) > 0 || count == 0) continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", with_blanks(name), count.dump());
    }
    return text.empty() ? text::message("none") : Message(text);
}

/// Returns the index of a sample, and its distance from the last sample received.
Message index_text(const json& status, std::int64_t here) {
    const json& received = status.at("received");
    Message text = std::to_string(here);
    if (!received.is_number()) return text;
    const auto samples = received.get<std::int64_t>() - here;
    text += text::message(", {} behind", samples);
    const auto rate_hz = status.at("/device/output_rate_hz"_json_pointer).get<double>();
    return rate_hz > 0.0 ? text + fmt::format(" ({:.1f} s)", static_cast<double>(samples) / rate_hz)
                         : text;
}

/// Returns the word of the catalogue for a state of the interface.
Message word_text(std::string_view state) {
    return text::marked_message(state == "given_up" ? text::marked("given up") : state);
}

std::string number_text(const Field& field, const json& value) {
    if (field.unit == "bytes") return fmt::format("{:.1f} GB", value.get<double>() / 1e9);
    const int decimals = field.shown.decimals;
    return (decimals == Shown::kAllDecimals
                ? value.dump()
                : fmt::format("{:.{}f}", value.get<double>(), decimals)) +
           (field.unit.empty() ? "" : " " + std::string(field.unit));
}

/// Returns a value without its label; empty if it is not known or not to be shown.
Message value_of(const Field& field, const json& value, const json& status) {
    using As = Shown::As;
    if (value.is_null()) return {};
    if (value.is_number_float() && !std::isfinite(value.get<double>())) return {};
    switch (field.shown.as) {
        case As::index:
            return index_text(status, value.get<std::int64_t>());
        case As::counts:
            return troubles(value);
        case As::word:
            return word_text(value.get_ref<const std::string&>());
        case As::value:
        case As::denial:
            break;
    }
    return value.is_string() ? value.get<std::string>() : number_text(field, value);
}

/// Returns a field as a part of its row; empty if it is not shown.
Message part_of(const Field& field, const json& value, const json& status) {
    const Message label = text::marked_message(field.shown.label);
    if (value.is_boolean())
        return value.get<bool>() != (field.shown.as == Shown::As::denial) ? label : Message();
    const Message shown = value_of(field, value, status);
    return shown.empty() || label.empty() ? shown : label + " " + shown;
}

}  // namespace

Message joined(const json& parts) {
    Message whole;
    for (const json& one : parts)
        whole += whole.empty() ? text::parse_message(one, "")
                               : Message("; ") + text::parse_message(one, "");
    return whole;
}

std::vector<Row> recorder_rows(const json& status) {
    const auto level = status.at("level").get<std::string>();
    Message state = text::marked_message(level);
    if (const Message reasons = joined(status.at("reason_parts")); !reasons.empty())
        state += Message(": ") + reasons;
    std::vector<Row> rows{{text::marked("state"), state, level}};
    for (const Field& field : status_fields()) {
        const json::json_pointer path(field.path);
        if (field.shown.row.empty() || !status.contains(path)) continue;
        if (rows.back().label != field.shown.row)
            rows.push_back({std::string(field.shown.row), {}});
        const Message part = part_of(field, status.at(path), status);
        Message& text = rows.back().text;
        if (!part.empty()) text += text.empty() ? part : Message(", ") + part;
    }
    for (Row& row : rows)
        if (row.text.empty()) row.text = "-";
    return rows;
}

json to_json(const std::vector<Row>& rows) {
    json list = json::array();
    for (const Row& row : rows)
        list.push_back({{"label", row.label},
                        {"text", row.text},
                        {"text_parts", row.text.to_json()},
                        {"level", row.level}});
    return list;
}

}  // namespace a351::daemon::page
