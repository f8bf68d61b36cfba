#include "daemon/page/field_json.hpp"

#include <nlohmann/json.hpp>

namespace a351::daemon {
namespace {

using nlohmann::json;

json or_null(const std::optional<MilliGal>& value) { return value ? json(value->value()) : json(); }

}  // namespace

json to_json(const Verdict& verdict, UtcTime now) {
    json reasons = json::array(), checks = json::array();
    for (const Reason& reason : verdict.reasons) {
        if (!reason.is_met) reasons.push_back(reason.to_text());
        checks.push_back({{"quantity", reason.quantity},
                          {"value", reason.value},
                          {"error", reason.error > 0.0 ? json(reason.error) : json()},
                          {"unit", reason.unit},
                          {"ending", reason.ending},
                          {"limit", reason.limit},
                          {"is_least", reason.is_least},
                          {"is_met", reason.is_met}});
    }
    const bool is_known = verdict.since != UtcTime{};
    return {{"state", to_text(verdict.state)},
            {"since", is_known ? json(to_rfc3339(verdict.since, 3)) : json()},
            {"held_s", is_known ? json(seconds_between(verdict.since, now)) : json()},
            {"reasons", reasons},
            {"checks", checks}};
}

json to_json(const OccupationReading& reading) {
    return {{"value_mgal", or_null(reading.value)},
            {"standard_error_mgal", or_null(reading.standard_error)}};
}

json to_json(const RunningReading& reading, MilliGal target) {
    return {{"value_mgal", or_null(reading.value)},
            {"standard_error_mgal", or_null(reading.standard_error)},
            {"used_s", reading.used_s},
            {"left_out_s", reading.left_out_s},
            {"target_mgal", target.value()},
            {"is_good_enough", reading.is_good_enough},
            {"needed_s", reading.needed_s ? json(*reading.needed_s) : json()}};
}

json tilt_of(const FieldStatus& field) {
    if (field.level_site.empty()) return nullptr;
    json level = {
        {"x_arcmin", nullptr},
        {"y_arcmin", nullptr},
        {"limit_arcmin", kMostTiltArcmin},
        {"is_within", nullptr},
        {"advice", json::array()},
        {"reference", {{"site", field.level_site}, {"utc", to_rfc3339(field.level_utc, 3)}}}};
    if (!field.level) return level;
    level["x_arcmin"] = field.level->tilt_arcmin[0];
    level["y_arcmin"] = field.level->tilt_arcmin[1];
    level["is_within"] = field.level->is_within;
    level["advice"] = field.level->advice;
    return level;
}

json channels_of(const LiveRecord& live) {
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

}  // namespace a351::daemon
