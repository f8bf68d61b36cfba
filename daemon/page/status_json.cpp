#include "daemon/page/status_json.hpp"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>

namespace a351::daemon::page {
namespace {

using nlohmann::json;

const char* name(timing::State state) {
    // In the order of the enumerators.
    constexpr std::array kTexts{text::marked("unlocked"), text::marked("coarse"),
                                text::marked("locked"), text::marked("holdover")};
    return kTexts.at(static_cast<std::size_t>(state));
}

/// Returns the parts of several sentences, from which another program makes a translation.
json parts_of(const std::vector<text::Message>& messages) {
    json list = json::array();
    for (const text::Message& one : messages) list.push_back(one.to_json());
    return list;
}

template <class Number>
json or_null(const std::optional<Number>& number) {
    return number ? json(*number) : json();
}

template <class Unit>
json or_null(const std::optional<Quantity<Unit>>& quantity) {
    return quantity ? json(quantity->value()) : json();
}

json verdict_of(const status::Status& status, Nanoseconds stale_after) {
    const auto no_data = [&](const text::Message& reason, std::optional<UtcTime> since) {
        json verdict = to_json(
            verdict::Verdict{verdict::State::no_data, since.value_or(UtcTime{}), {}}, status.now);
        verdict["reasons"].push_back(reason.english());
        verdict["reason_parts"].push_back(reason.to_json());
        return verdict;
    };
    if (!status.last_sample)
        return no_data(text::message("no sample has been received yet"), std::nullopt);
    if (status.now - *status.last_sample <= stale_after) return to_json(status.verdict, status.now);
    return no_data(
        text::message("last sample {:.1f} s ago", seconds_between(*status.last_sample, status.now)),
        status.last_sample);
}

json occupation_of(const survey::Occupations& occupations, const survey::FieldStatus& field,
                   UtcTime now) {
    const auto& running = occupations.running();
    if (!running) return nullptr;
    json occupation = to_json(*running, now);
    occupation["reading"] = field.reading ? to_json(*field.reading, occupations.target()) : json();
    occupation["whole"] = to_json(field.whole, occupations.target());
    occupation["planned_s"] = std::chrono::duration<double>(occupations.planned()).count();
    occupation["planned_set_ups"] = field.plan.planned;
    occupation["has_own_plan"] = running->planned_set_ups.has_value();
    occupation["set_up_left_s"] = field.plan.left_s;
    occupation["propose_set_up"] = field.plan.proposes_next;
    occupation["may_stop"] = field.plan.may_stop;
    occupation["warnings"] = field.warnings;
    occupation["warning_parts"] = parts_of(field.warnings);
    occupation["moved"] = nullptr;
    if (field.moved)
        occupation["moved"] = {{"utc", to_rfc3339(field.moved->time, 3)},
                               {"is_at_start", field.moved->is_at_start}};
    return occupation;
}

json rate_of(const status::Status& status) {
    using Hours = std::chrono::duration<double, std::ratio<3600>>;
    const auto& measured = status.measured_rate;
    return {{"declared_hz", or_null(status.declared_rate_hz)},
            {"measured_hz", measured ? json(measured->rate.value()) : json()},
            {"uncertainty_ppm", measured ? json(measured->uncertainty_ppm) : json()},
            {"span_h", measured ? json(Hours(measured->span).count()) : json()},
            {"advice", status.rate_advice}};
}

json clock_step_of(const std::optional<status::ClockStep>& step) {
    if (!step) return nullptr;
    return {{"utc", to_rfc3339(step->after, 3)},
            {"clock_before", to_rfc3339(step->before, 3)},
            {"by_s", seconds_between(step->before, step->after)}};
}

json sample_of(const status::Status& status) {
    if (!status.last_sample) return nullptr;
    json acceleration = json::array();
    for (const auto axis : status.acceleration) acceleration.push_back(1e3 * axis.value());
    return {{"utc", to_rfc3339(*status.last_sample, 3)},
            {"age_s", seconds_between(*status.last_sample, status.now)},
            {"acceleration_mg", acceleration},
            {"temperature_degc", status.temperature.value()}};
}

json oven_of(const std::optional<source::OvenLinkStatus>& oven) {
    if (!oven) return {{"state", text::marked("disabled")}};
    const auto& values = oven->values;
    const auto& age = oven->age;
    return {{"state", source::to_text(oven->state)},
            {"trouble", oven->trouble},
            {"port", oven->port},
            {"decimals", oven->decimals},
            {"is_stale", oven->is_stale},
            {"polls", source::polls_by_outcome(*oven)},
            {"age_s", age ? json(std::chrono::duration<double>(*age).count()) : json()},
            {"process_value_degc", values ? or_null(values->process_value) : json()},
            {"set_point_degc", values ? json(values->set_point.value()) : json()},
            {"heating_percent", values ? json(values->heating.value()) : json()},
            {"status_word", values ? json(values->status) : json()},
            {"has_input_error", values ? json(oven::has_input_error(values->status)) : json()}};
}

json counters_of(const status::Status& status) {
    const auto& c = status.counters;
    json counters = {{"bytes", c.bytes},
                     {"frames", c.frames},
                     {"bytes_skipped", c.bytes_skipped},
                     {"checksum_errors", c.checksum_errors},
                     {"framing_errors", c.framing_errors},
                     {"gaps", c.gaps},
                     {"samples_missing", c.samples_missing},
                     {"duplicates", c.duplicates},
                     {"anomalies", c.anomalies},
                     {"integer_records", c.integer_records},
                     {"error_flags", c.error_flags},
                     {"sessions", c.sessions},
                     {"records_withheld", c.records_withheld}};
    for (const auto& [key, count] : status.more_counters) counters[key] = count;
    return counters;
}

}  // namespace

std::string_view to_text(status::Status::Level level) noexcept {
    // In the order of the enumerators.
    constexpr std::array kTexts{text::marked("good"), text::marked("warning"),
                                text::marked("fault")};
    return kTexts.at(static_cast<std::size_t>(level));
}

json to_json(const status::Status& status, const survey::Occupations& occupations,
             const survey::FieldStatus& field, const live::Record& live, Nanoseconds stale_after) {
    json uncertainty_ms;
    if (const auto& known = status.timing_uncertainty)
        uncertainty_ms = std::chrono::duration<double, std::milli>(*known).count();
    json all = {{"api", kApiVersion},
                {"version", status.version},
                {"level", to_text(status.level)},
                {"reasons", status.reasons},
                {"reason_parts", parts_of(status.reasons)},
                {"session", status.session.empty() ? json() : json(status.session)},
                {"now", to_rfc3339(status.now, 3)},
                {"received", or_null(status.received)},
                {"journaled", or_null(status.journaled)},
                {"archived", or_null(status.archived)},
                {"timing",
                 {{"state", name(status.timing_state)},
                  {"uncertainty_ms", uncertainty_ms},
                  {"clock_step", clock_step_of(status.clock_step)},
                  {"rate", rate_of(status)}}},
                {"verdict", verdict_of(status, stale_after)},
                {"occupation", occupation_of(occupations, field, status.now)},
                {"target_mgal", occupations.target().value()},
                {"changes", occupations.changes()},
                {"tilt", tilt_of(field)},
                {"live", channels_of(live)},
                {"sample", sample_of(status)},
                {"counters", counters_of(status)},
                {"oven", oven_of(status.oven)},
                {"device",
                 {{"port", status.port},
                  {"state", status.link_state},
                  {"trouble", status.link_trouble},
                  {"profile", status.profile},
                  {"profile_verified", status.is_profile_verified},
                  {"product_id", status.product_id},
                  {"serial_number", status.serial_number},
                  {"assumed", status.is_device_assumed},
                  {"filter", status.filter},
                  {"output_rate_hz", status.output_rate_hz}}},
                {"disk",
                 {{"free_bytes", or_null(status.disk_free_bytes)},
                  {"reserve", status.disk_reserve},
                  {"longest_sync_ms", status.longest_sync.count()}}}};
    // A client of a single oven needs nothing of a second one.
    if (status.outer_oven) all["outer_oven"] = oven_of(status.outer_oven);
    return all;
}

json to_json(const events::RunningOccupation& running, UtcTime now) {
    return {{"key", running.key},
            {"site", running.site},
            {"number", running.number},
            {"operator", running.operator_name},
            {"note", running.note},
            {"start", to_rfc3339(running.start, 3)},
            {"set_up", to_rfc3339(running.set_ups.back(), 3)},
            {"set_up_count", running.set_ups.size()},
            {"running_s", seconds_between(running.start, now)},
            {"session", running.session ? json(running.session->to_hex()) : json()},
            {"index", or_null(running.index)}};
}

json to_json(const events::Occupation& occupation) {
    json set_ups = json::array();
    for (const auto& one : occupation.set_ups)
        set_ups.push_back({{"start", to_rfc3339(one.start, 3)}, {"end", to_rfc3339(one.end, 3)}});
    return {{"key", occupation.key},       {"site", occupation.site},
            {"number", occupation.number}, {"operator", occupation.operator_name},
            {"note", occupation.note},     {"used", nullptr},
            {"set_ups", set_ups}};
}

json to_json(const survey::SiteDistance& one) {
    const text::Site& site = one.site;
    const auto placed = [&site](double value) { return site.is_placed ? json(value) : json(); };
    return {{"site", site.name},
            {"longitude_deg", placed(site.longitude.value())},
            {"latitude_deg", placed(site.latitude.value())},
            {"altitude_m", site.has_altitude ? json(site.altitude.value()) : json()},
            {"gravity_mgal", or_null(site.gravity)},
            {"distance_m", or_null(one.distance)}};
}

json to_json(const verdict::Verdict& verdict, UtcTime now) {
    json reasons = json::array(), parts = json::array(), checks = json::array();
    for (const verdict::Reason& reason : verdict.reasons) {
        if (!reason.is_met) {
            const text::Message message = reason.to_message();
            reasons.push_back(message.english());
            parts.push_back(message.to_json());
        }
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
    return {{"state", verdict::to_text(verdict.state)},
            {"since", is_known ? json(to_rfc3339(verdict.since, 3)) : json()},
            {"held_s", is_known ? json(seconds_between(verdict.since, now)) : json()},
            {"time_left_s", or_null(verdict.time_left_s)},
            {"reasons", reasons},
            {"reason_parts", parts},
            {"checks", checks}};
}

json mean_of(const verdict::RunningReading& reading) {
    json limits;
    if (const auto& known = reading.set_up_sd_limits)
        limits = {known->front().value(), known->back().value()};
    return {{"value_mgal", or_null(reading.value)},
            {"standard_error_mgal", or_null(reading.standard_error)},
            {"set_ups", reading.set_ups},
            {"set_up_sd_mgal", or_null(reading.set_up_sd)},
            {"set_up_sd_limits_mgal", limits},
            {"set_up_error_mgal", or_null(reading.set_up_error)}};
}

json to_json(const verdict::RunningReading& reading, MilliGal target) {
    json object = mean_of(reading);
    object.update({{"used_s", reading.used_s},
                   {"left_out_s", reading.left_out_s},
                   {"target_mgal", target.value()},
                   {"is_good_enough", reading.is_good_enough},
                   {"needed_s", or_null(reading.needed_s)}});
    return object;
}

json tilt_of(const survey::FieldStatus& field) {
    if (field.level_site.empty()) return nullptr;
    const auto& level = field.level;
    const live::Level known = level.value_or(live::Level{});
    return {{"axes", {std::string(1, known.axes[0]), std::string(1, known.axes[1])}},
            {"x_arcmin", level ? json(level->tilt_arcmin[0]) : json()},
            {"y_arcmin", level ? json(level->tilt_arcmin[1]) : json()},
            {"limit_arcmin", live::kMostTiltArcmin},
            {"is_within", level ? json(level->is_within) : json()},
            {"advice", level ? json(level->advice) : json::array()},
            {"advice_parts", level ? parts_of(level->advice) : json::array()},
            {"reference", {{"site", field.level_site}, {"utc", to_rfc3339(field.level_utc, 3)}}}};
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
