#include "daemon/page/message.hpp"

#include <fmt/core.h>
#include <strings.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "protocol/core/input_error.hpp"
#include "protocol/text/json_text.hpp"

namespace a351::daemon::page {
namespace {

std::optional<std::string> percent_decoded(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        if (i + 2 >= text.size()) return std::nullopt;
        const char* const digits = text.data() + i + 1;
        unsigned value = 0;
        if (std::from_chars(digits, digits + 2, value, 16).ptr != digits + 2) return std::nullopt;
        decoded += static_cast<char>(value);
        i += 2;
    }
    return decoded;
}

}  // namespace

std::vector<std::string> Request::values(std::string_view name) const {
    std::vector<std::string> found;
    for (const auto& [key, value] : headers) {
        if (key.size() == name.size() && strncasecmp(key.data(), name.data(), name.size()) == 0)
            found.push_back(value);
    }
    return found;
}

Response refusal(int status, const text::Message& trouble) {
    const nlohmann::json body = {{"error", trouble.english()}, {"error_parts", trouble.to_json()}};
    return {.status = status, .body = text::json_text(body) + "\n"};
}

void require_allowed(std::string_view part, const std::string& key,
                     const std::vector<std::string>& allowed) {
    if (std::ranges::count(allowed, key) > 0) return;
    std::string list;
    for (const auto& one : allowed) list += (list.empty() ? "" : ", ") + one;
    throw InputError(
        fmt::format("{}: key {} is unknown; allowed: {}", part, key, list.empty() ? "none" : list));
}

UtcTime parse_instant(std::string_view part, const std::string& key, const std::string& text) {
    if (const auto time = parse_rfc3339(text)) return *time;
    throw InputError(fmt::format(
        "{}: key {} = {}: not an instant; allowed: RFC 3339 such as 2026-01-31T09:30:00Z", part,
        key, text));
}

std::map<std::string, std::string> parse_query(std::string_view query,
                                               const std::vector<std::string>& allowed) {
    std::map<std::string, std::string> values;
    while (!query.empty()) {
        const auto part = query.substr(0, query.find('&'));
        query.remove_prefix(std::min(query.size(), part.size() + 1));
        const std::string key(part.substr(0, part.find('=')));
        require_allowed("query", key, allowed);
        const auto value = percent_decoded(part.substr(std::min(part.size(), key.size() + 1)));
        if (!value) throw InputError("query: key " + key + ": broken percent encoding");
        if (!values.emplace(key, *value).second)
            throw InputError("query: key " + key + ": given twice");
    }
    return values;
}

}  // namespace a351::daemon::page
