#include "daemon/page/order.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/page/message.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::daemon {

Order parse_order(std::string_view body, const std::vector<std::string>& allowed) {
    const auto parsed = nlohmann::json::parse(body, nullptr, false);
    if (!parsed.is_object()) throw InputError("body: not a JSON object");
    Order order;
    for (const auto& [key, value] : parsed.items()) {
        if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
            throw InputError("body: key " + key + " is unknown; allowed: " + joined(allowed));
        }
        if (value.is_null()) continue;
        if (!value.is_string()) throw InputError("body: key " + key + ": not a text");
        const auto text = value.get<std::string>();
        if (key == "site") order.site = text;
        if (key == "operator") order.remark.operator_name = text;
        if (key == "note") order.remark.note = text;
        if (key != "at" || text.empty()) continue;
        order.at = parse_rfc3339(text);
        if (!order.at) {
            throw InputError("body: key at = " + text +
                             ": not an instant; allowed: RFC 3339 such as 2026-01-31T09:30:00Z");
        }
    }
    return order;
}

MilliGal parse_target(std::string_view body) {
    const auto parsed = nlohmann::json::parse(body, nullptr, false);
    if (!parsed.is_object() || parsed.size() != 1 || !parsed.contains("target_mgal"))
        throw InputError("body: allowed: one key, target_mgal");
    const auto& target = parsed.at("target_mgal");
    if (!target.is_number()) throw InputError("body: key target_mgal: not a number");
    return MilliGal(target.get<double>());
}

}  // namespace a351::daemon
