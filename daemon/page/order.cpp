#include "daemon/page/order.hpp"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "daemon/page/message.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/whole_number.hpp"
#include "protocol/text/echo.hpp"

namespace a351::daemon::page {

using nlohmann::json;

namespace {

/// Reads a whole number; the rules of the stay limit it.
int parse_set_ups(const std::string& key, const std::string& text) {
    const auto count = parse_whole<int>(text);
    if (!count)
        throw InputError(fmt::format("body: key {} = {}: not a whole number; allowed: {} to {}",
                                     key, text::echoed(text), events::kFewestPlannedSetUps,
                                     events::kMostPlannedSetUps));
    return *count;
}

int parse_face(const std::string& key, const std::string& text) {
    const auto face = events::parse_face(text);
    if (!face)
        throw InputError(
            fmt::format("body: key {} = {}: not a face; allowed: + or -", key, text::echoed(text)));
    return *face;
}

}  // namespace

Order parse_order(std::string_view body, const std::vector<std::string>& allowed) {
    const auto parsed = json::parse(body, nullptr, false);
    if (!parsed.is_object()) throw InputError("body: not a JSON object");
    Order order;
    for (const auto& [key, value] : parsed.items()) {
        require_allowed("body", key, allowed);
        if (value.is_null()) continue;
        if (!value.is_string()) throw InputError("body: key " + key + ": not a text");
        const auto text = value.get<std::string>();
        if (key == "key") order.key = text;
        if (key == "code") order.code = text;
        if (key == "site") order.site = text;
        if (key == "operator") order.remark.operator_name = text;
        if (key == "note") order.remark.note = text;
        if (key == "reason") order.remark.reason = text;
        if (key == "set_ups" && !text.empty()) order.set_ups = parse_set_ups(key, text);
        if (key == "face" && !text.empty()) order.face = parse_face(key, text);
        for (const auto& [name, instant] :
             {std::pair{"at", &order.at}, {"from", &order.from}, {"to", &order.to}})
            if (key == name && !text.empty()) *instant = parse_instant("body", key, text);
    }
    return order;
}

text::Site parse_new_site(std::string_view body) {
    const auto parsed = json::parse(body, nullptr, false);
    if (!parsed.is_object()) throw InputError("body: not a JSON object");
    for (const auto& [key, value] : parsed.items()) {
        require_allowed("body", key,
                        {"site", "latitude_deg", "longitude_deg", "altitude_m", "gravity_mgal"});
        if (value.is_null()) continue;
        if (key == "site" && !value.is_string()) throw InputError("body: key site: not a text");
        if (key != "site" && !value.is_number())
            throw InputError("body: key " + key + ": not a number");
    }
    const auto is_given = [&](const char* key) {
        return parsed.contains(key) && !parsed.at(key).is_null();
    };
    for (const char* key : {"site", "latitude_deg", "longitude_deg"})
        if (!is_given(key)) throw InputError(std::string("body: key ") + key + " is missing");
    text::Site site;
    site.name = parsed.at("site").get<std::string>();
    site.latitude = Degrees(parsed.at("latitude_deg").get<double>());
    site.longitude = Degrees(parsed.at("longitude_deg").get<double>());
    site.has_altitude = is_given("altitude_m");
    if (site.has_altitude) site.altitude = Metres(parsed.at("altitude_m").get<double>());
    if (is_given("gravity_mgal")) site.gravity = MilliGal(parsed.at("gravity_mgal").get<double>());
    return site;
}

}  // namespace a351::daemon::page
