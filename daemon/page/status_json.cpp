#include "daemon/page/status_json.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "daemon/page/field_values.hpp"

namespace a351::daemon::page {

using nlohmann::json;

std::string_view to_text(status::Status::Level level) noexcept {
    // In the order of the enumerators.
    constexpr std::array kTexts{text::marked("good"), text::marked("warning"),
                                text::marked("fault")};
    return kTexts.at(static_cast<std::size_t>(level));
}

json to_json(const Moment& now) {
    json all;
    for (const Field& field : status_fields()) {
        json value = field.value(now);
        if (!value.is_discarded()) all[json::json_pointer(field.path)] = std::move(value);
    }
    return all;
}

json parts_of(const std::vector<text::Message>& messages) {
    json list = json::array();
    for (const text::Message& one : messages) list.push_back(one.to_json());
    return list;
}

json to_json(const events::RunningOccupation& running, UtcTime now) {
    return {{"key", running.key},
            {"site", running.site},
            {"number", running.number},
            {"operator", running.operator_name},
            {"note", running.note},
            {"start", json_of(running.start)},
            {"set_up", json_of(running.set_ups.back())},
            {"set_up_count", running.set_ups.size()},
            {"running_s", seconds_between(running.start, now)},
            {"session", running.session ? json(running.session->to_hex()) : json()},
            {"index", json_of(running.index)}};
}

json to_json(const events::Occupation& occupation) {
    json set_ups = json::array();
    for (const auto& one : occupation.set_ups)
        set_ups.push_back({{"start", json_of(one.start)}, {"end", json_of(one.end)}});
    return {{"key", occupation.key},       {"site", occupation.site},
            {"number", occupation.number}, {"operator", occupation.operator_name},
            {"note", occupation.note},     {"set_ups", set_ups}};
}

json to_json(const survey::SiteDistance& one) {
    const text::Site& site = one.site;
    const auto placed = [&site](double value) { return site.is_placed ? json(value) : json(); };
    return {{"site", site.name},
            {"longitude_deg", placed(site.longitude.value())},
            {"latitude_deg", placed(site.latitude.value())},
            {"altitude_m", site.has_altitude ? json(site.altitude.value()) : json()},
            {"gravity_mgal", json_of(site.gravity)},
            {"distance_m", json_of(one.distance)}};
}

json checks_of(const verdict::Verdict& verdict) {
    json checks = json::array();
    for (const verdict::Reason& reason : verdict.reasons) {
        checks.push_back({{"quantity", reason.quantity},
                          {"value", reason.value},
                          {"error", reason.error > 0.0 ? json(reason.error) : json()},
                          {"unit", reason.unit},
                          {"ending", reason.ending},
                          {"limit", reason.limit},
                          {"is_least", reason.is_least},
                          {"is_met", reason.is_met}});
    }
    return checks;
}

json to_json(const verdict::RunningReading& reading) {
    json limits;
    if (const auto& known = reading.set_up_sd_limits)
        limits = {known->front().value(), known->back().value()};
    return {{"value_mgal", json_of(reading.value)},
            {"set_ups", reading.set_ups},
            {"set_up_sd_mgal", json_of(reading.set_up_sd)},
            {"set_up_sd_limits_mgal", limits},
            {"set_up_error_mgal", json_of(reading.set_up_error)},
            {"used_s", reading.used_s},
            {"left_out_s", reading.left_out_s}};
}

json gravity_of(const survey::SoFar& so_far, const std::string& key) {
    const auto found = so_far.stays.find(key);
    if (found == so_far.stays.end()) return {};
    const survey::StayGravity& stay = found->second;
    return {{"gravity_mgal", json_of(stay.gravity)},
            {"u_mgal", json_of(stay.u)},
            {"missing_parts", stay.missing.empty() ? json() : stay.missing.to_json()}};
}

json channels_of(const live::Record& live) {
    const wire::DeviceProfile& profile = live.profile();
    json channels = json::array();
    for (const char* axis : {"x", "y", "z"}) {
        channels.push_back({{"name", axis},
                            {"unit", "mg"},
                            {"scale", 1e3 * profile.acceleration(1).value()},
                            {"offset", 0.0}});
    }
    channels.push_back({{"name", "temperature"},
                        {"unit", "degC"},
                        {"scale", profile.temperature_slope_degc},
                        {"offset", profile.temperature_offset_degc}});
    return {
        {"rate_hz", live.rate_hz()}, {"interval_s", 1.0 / live.rate_hz()}, {"channels", channels}};
}

}  // namespace a351::daemon::page
