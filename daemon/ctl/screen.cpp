#include "daemon/ctl/screen.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/ctl/requests.hpp"
#include "protocol/text/columns.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::ctl {
namespace {

using nlohmann::json;

/// Returns the member at a path such as "device/port"; null if there is none.
const json& at(const json& object, const std::string& path) {
    static const json kNull;
    const json::json_pointer pointer("/" + path);
    return object.contains(pointer) ? object.at(pointer) : kNull;
}

std::string text_of(const json& value) {
    if (value.is_number_integer()) return value.dump();
    const std::string text =
        value.is_string() ? printable(value.get_ref<const std::string&>()) : "";
    return text.empty() ? "-" : text;
}
std::string text_of(const json& object, const std::string& path) {
    return text_of(at(object, path));
}

std::string number_of(const json& value, const char* format) {
    return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "-";
}
std::string number_of(const json& object, const std::string& path, const char* format) {
    return number_of(at(object, path), format);
}

std::string coloured(const std::string& text, const std::string& level, bool is_coloured) {
    if (!is_coloured || level.empty()) return text;
    const char* code = level == "good" ? "32" : level == "warning" ? "33" : "31";
    return fmt::format("\x1b[1;{}m{}\x1b[0m", code, text);
}

/// Formats rows as a table; each column is as wide as its widest cell.
std::string table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], text::columns_of(row[i]));
    std::string text;
    for (const auto& row : rows) {
        std::string shown;
        for (std::size_t i = 0; i < row.size(); ++i)
            shown += row[i] + std::string(widths[i] - text::columns_of(row[i]) + 2, ' ');
        text += shown.substr(0, shown.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
        // U+0080 to U+009F are control characters too; in UTF-8 they begin with C2.
        const bool is_c1 = byte == 0xC2 && next >= 0x80 && next <= 0x9F;
        shown += byte < 0x20 || byte == 0x7F || is_c1 ? '?' : text[i];
        if (is_c1) ++i;
    }
    return shown;
}

std::string status_screen(const json& answer, bool is_coloured) {
    std::string screen;
    for (const json& row : at(answer, "rows")) {
        const std::string label = printable(row.value("label", ""));
        const std::string text = printable(sentence_of(row, "text", "text_parts"));
        screen += fmt::format("{:13}{}\n", text::translated(label),
                              coloured(text, row.value("level", ""), is_coloured));
    }
    return screen;
}

std::string site_table(const json& answer) {
    std::vector<std::vector<std::string>> rows = {
        {"site", "longitude_deg", "latitude_deg", "altitude_m", "gravity_mgal", "distance_m"}};
    for (const auto& site : at(answer, "sites")) {
        rows.push_back(
            {text_of(site, "site"), number_of(site, "longitude_deg", "{:.6f}"),
             number_of(site, "latitude_deg", "{:.6f}"), number_of(site, "altitude_m", "{:.2f}"),
             number_of(site, "gravity_mgal", "{:.3f}"), number_of(site, "distance_m", "{:.0f}")});
    }
    const std::string doubt = printable(sentence_of(answer, "doubt", "doubt_parts"));
    return table(rows) + (doubt.empty() ? "" : doubt + "\n");
}

std::string occupation_table(const json& answer) {
    std::vector<std::vector<std::string>> rows = {
        {"site", "stay", "start", "end", "gravity_mgal", "u_mgal", "key", "operator", "note"}};
    const auto add = [&](const json& one, const std::string& number, const std::string& note) {
        const json& set_ups = at(one, "set_ups");
        const json& gravity = at(one, "gravity");
        rows.push_back({text_of(one, "site"), number, text_of(set_ups.front(), "start"),
                        text_of(set_ups.back(), "end"),
                        number_of(gravity, "gravity_mgal", "{:.1f}"),
                        number_of(gravity, "u_mgal", "{:.1f}"), text_of(one, "key"),
                        text_of(one, "operator"), note});
    };
    for (const auto& one : at(answer, "occupations"))
        add(one, text_of(one, "number"), text_of(one, "note"));
    for (const auto& one : at(answer, "discarded")) add(one, "-", text::tr("discarded"));
    return table(rows);
}

int plugin_status(const json& answer) {
    const json& level = at(answer, "level");
    return level == "good" ? 0 : level == "warning" ? 1 : level == "fault" ? 2 : 3;
}

}  // namespace a351::daemon::ctl
