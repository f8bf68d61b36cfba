#include "daemon/page/query.hpp"

#include <algorithm>
#include <optional>

#include "daemon/page/message.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::daemon {
namespace {

std::optional<std::string> percent_decoded(std::string_view text) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        return -1;
    };
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        if (i + 2 >= text.size()) return std::nullopt;
        const int high = digit(text[i + 1]);
        const int low = digit(text[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        decoded += static_cast<char>(16 * high + low);
        i += 2;
    }
    return decoded;
}

}  // namespace

std::map<std::string, std::string> parse_query(std::string_view query,
                                               const std::vector<std::string>& allowed) {
    std::map<std::string, std::string> values;
    while (!query.empty()) {
        const auto part = query.substr(0, query.find('&'));
        query.remove_prefix(std::min(query.size(), part.size() + 1));
        const std::string key(part.substr(0, part.find('=')));
        if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
            throw InputError("query: key " + key + " is unknown; allowed: " + joined(allowed));
        }
        const auto value = percent_decoded(part.substr(std::min(part.size(), key.size() + 1)));
        if (!value) throw InputError("query: key " + key + ": broken percent encoding");
        if (!values.emplace(key, *value).second) {
            throw InputError("query: key " + key + ": given twice");
        }
    }
    return values;
}

}  // namespace a351::daemon
