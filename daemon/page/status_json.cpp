#include "daemon/page/status_json.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "daemon/page/field_json.hpp"

namespace a351::daemon {
namespace {

using nlohmann::json;

const char* name(timing::TimingState state) {
    switch (state) {
        case timing::TimingState::unlocked:
            return "unlocked";
        case timing::TimingState::coarse:
            return "coarse";
        case timing::TimingState::locked:
            return "locked";
        case timing::TimingState::holdover:
            return "holdover";
    }
    return "unlocked";
}

template <class Number>
json or_null(const std::optional<Number>& number) {
    return number ? json(*number) : json();
}

json verdict_of(const Status& status, Nanoseconds stale_after) {
    const auto no_data = [&](const char* reason, std::optional<UtcTime> since) {
        json verdict =
            to_json(Verdict{VerdictState::no_data, since.value_or(UtcTime{}), {}}, status.now);
        verdict["reasons"].push_back(reason);
        return verdict;
    };
    if (!status.last_sample) return no_data("no sample has been received yet", std::nullopt);
    if (status.now - *status.last_sample <= stale_after) return to_json(status.verdict, status.now);
    char reason[64];
    std::snprintf(reason, sizeof reason, "last sample %.1f s ago",
                  seconds_between(*status.last_sample, status.now));
    return no_data(reason, status.last_sample);
}

json occupation_of(const Occupations& occupations, const FieldStatus& field, UtcTime now) {
    const auto& running = occupations.running();
    if (!running) return nullptr;
    json occupation = to_json(*running, now);
    occupation["reading"] = field.reading ? to_json(*field.reading, occupations.target()) : json();
    occupation["whole"] = to_json(field.whole);
    occupation["half_time_s"] = or_null(field.half_time_s);
    occupation["propose_set_up"] = field.proposes_set_up;
    occupation["warnings"] = field.warnings;
    return occupation;
}

json rate_of(const Status& status) {
    json rate = {{"declared_hz", or_null(status.declared_rate_hz)},
                 {"measured_hz", nullptr},
                 {"uncertainty_ppm", nullptr},
                 {"span_h", nullptr},
                 {"advice", status.rate_advice}};
    if (const auto& measured = status.measured_rate) {
        rate["measured_hz"] = measured->rate.value();
        rate["uncertainty_ppm"] = measured->uncertainty_ppm;
        rate["span_h"] = std::chrono::duration<double, std::ratio<3600>>(measured->span).count();
    }
    return rate;
}

json sample_of(const Status& status) {
    if (!status.last_sample) return nullptr;
    json acceleration = json::array();
    for (const auto axis : status.acceleration) acceleration.push_back(1e3 * axis.value());
    return {{"utc", to_rfc3339(*status.last_sample, 3)},
            {"age_s", seconds_between(*status.last_sample, status.now)},
            {"acceleration_mg", acceleration},
            {"temperature_degc", status.temperature.value()}};
}

json oven_of(const std::optional<OvenStatus>& oven) {
    if (!oven) return {{"state", "disabled"}};
    json object = {{"state", oven->state},       {"trouble", oven->trouble},
                   {"port", oven->port},         {"decimals", oven->decimals},
                   {"is_stale", oven->is_stale}, {"polls", oven->polls}};
    for (const char* key : {"process_value_degc", "set_point_degc", "heating_percent",
                            "status_word", "has_input_error", "age_s"}) {
        object[key] = nullptr;
    }
    if (oven->age) object["age_s"] = std::chrono::duration<double>(*oven->age).count();
    if (const auto& values = oven->values) {
        if (values->process_value) object["process_value_degc"] = values->process_value->value();
        object["set_point_degc"] = values->set_point.value();
        object["heating_percent"] = values->heating.value();
        object["status_word"] = values->status;
        object["has_input_error"] = oven::has_input_error(values->status);
    }
    return object;
}

json counters_of(const Status& status) {
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

std::string_view to_text(Status::Level level) noexcept {
    switch (level) {
        case Status::Level::good:
            return "good";
        case Status::Level::warning:
            return "warning";
        case Status::Level::fault:
            return "fault";
    }
    return "fault";
}

json to_json(const Status& status, const Occupations& occupations, const FieldStatus& field,
             const LiveRecord& live, Nanoseconds stale_after) {
    json uncertainty_ms;
    if (const auto& known = status.timing_uncertainty)
        uncertainty_ms = std::chrono::duration<double, std::milli>(*known).count();
    return {{"api", kApiVersion},
            {"version", status.version},
            {"level", to_text(status.level)},
            {"reasons", status.reasons},
            {"session", status.session.empty() ? json() : json(status.session)},
            {"now", to_rfc3339(status.now, 3)},
            {"received", or_null(status.received)},
            {"journaled", or_null(status.journaled)},
            {"archived", or_null(status.archived)},
            {"timing",
             {{"state", name(status.timing_state)},
              {"uncertainty_ms", uncertainty_ms},
              {"rate", rate_of(status)}}},
            {"verdict", verdict_of(status, stale_after)},
            {"occupation", occupation_of(occupations, field, status.now)},
            {"target_mgal", occupations.target().value()},
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
}

json to_json(const RunningOccupation& running, UtcTime now) {
    return {{"site", running.site},
            {"number", running.number},
            {"operator", running.remark.operator_name},
            {"note", running.remark.note},
            {"start", to_rfc3339(running.start, 3)},
            {"set_up", to_rfc3339(running.set_ups.back(), 3)},
            {"set_up_count", running.set_ups.size()},
            {"running_s", seconds_between(running.start, now)},
            {"session", running.session ? json(running.session->to_hex()) : json()},
            {"index", or_null(running.index)}};
}

json to_json(const record::Occupation& occupation) {
    json set_ups = json::array();
    for (const auto& one : occupation.set_ups) {
        set_ups.push_back({{"start", to_rfc3339(one.start, 3)}, {"end", to_rfc3339(one.end, 3)}});
    }
    return {{"site", occupation.site},
            {"number", occupation.number},
            {"note", occupation.note},
            {"used", or_null(occupation.used)},
            {"set_ups", set_ups}};
}

json to_json(const SiteDistance& one) {
    const text::Site& site = one.site;
    const auto placed = [&site](double value) { return site.is_placed ? json(value) : json(); };
    return {{"site", site.name},
            {"longitude_deg", placed(site.longitude.value())},
            {"latitude_deg", placed(site.latitude.value())},
            {"altitude_m", placed(site.altitude.value())},
            {"gravity_mgal", site.gravity ? json(site.gravity->value()) : json()},
            {"distance_m", one.distance ? json(one.distance->value()) : json()}};
}

}  // namespace a351::daemon
