#include "daemon/page/metrics.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "daemon/page/status_json.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;

using Labels = std::initializer_list<std::pair<std::string_view, std::string>>;

constexpr verdict::State kStates[] = {verdict::State::no_data, verdict::State::warming_up,
                                      verdict::State::settling, verdict::State::stable,
                                      verdict::State::disturbed};
constexpr status::Status::Level kLevels[] = {
    status::Status::Level::good, status::Status::Level::warning, status::Status::Level::fault};
/// Name of the only counter that can also decrease.
constexpr std::string_view kWaiting = "archive_records_waiting";

class Text {
public:
    /// Begins a metric; its samples follow.
    void metric(std::string_view name, std::string_view type, std::string_view help) {
        name_ = name;
        text_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
    }
    /// Adds a sample of the metric; nothing if the value is not a number.
    void sample(const json& value, Labels labels = {}, double scale = 1.0) {
        if (!value.is_number()) return;
        text_ += name_;
        char mark = '{';
        for (const auto& [key, label] : labels) {
            text_ += fmt::format("{}{}=\"{}\"", mark, key, escaped(label));
            mark = ',';
        }
        if (labels.size() > 0) text_ += '}';
        text_ += ' ' + (scale == 1.0 ? value : json(scale * value.get<double>())).dump() + '\n';
    }
    void gauge(std::string_view name, std::string_view help, const json& value,
               double scale = 1.0) {
        metric(name, "gauge", help);
        sample(value, {}, scale);
    }

    std::string text_;

private:
    static std::string escaped(std::string_view label) {
        std::string text;
        for (const char c : label) {
            if (c == '\\' || c == '"') text += '\\';
            text += c == '\n' ? std::string("\\n") : std::string(1, c);
        }
        return text;
    }

    std::string name_;
};

json at(const json& status, const char* pointer) {
    return status.value(json::json_pointer(pointer), json());
}

void tell_state(Text& text, const json& status) {
    text.metric("a351_up", "gauge", "1 while the daemon answers.");
    text.sample(1, {{"version", at(status, "/version").get<std::string>()}});
    text.metric("a351_level", "gauge",
                "1 for the present level, which is the exit status of a351ctl status.");
    for (const auto level : kLevels) {
        const std::string name(to_text(level));
        text.sample(at(status, "/level") == name ? 1 : 0, {{"level", name}});
    }
    text.metric("a351_verdict", "gauge", "1 for the present verdict.");
    for (const auto state : kStates) {
        const std::string name(verdict::to_text(state));
        text.sample(at(status, "/verdict/state") == name ? 1 : 0, {{"state", name}});
    }
    text.gauge("a351_occupation_running", "1 while an occupation runs.",
               at(status, "/occupation").is_object() ? 1 : 0);
}

void tell_record(Text& text, const json& status) {
    text.metric("a351_index", "gauge",
                "Index of the last sample of the session that was received, journaled, archived.");
    for (const char* stage : {"received", "journaled", "archived"})
        text.sample(status.value(stage, json()), {{"stage", stage}});
    text.gauge("a351_sample_age_seconds", "Age of the last sample, instrument time.",
               at(status, "/sample/age_s"));
    text.gauge("a351_timing_uncertainty_seconds",
               "Uncertainty (95 %) of the time of the last sample.",
               at(status, "/timing/uncertainty_ms"), 1e-3);
    text.gauge("a351_measured_rate_hertz", "Measured sample rate of the sensor.",
               at(status, "/timing/rate/measured_hz"));

    text.metric("a351_counter_total", "counter", "Counters since the daemon's start, by kind.");
    for (const auto& [kind, count] : status.at("counters").items())
        if (kind != kWaiting) text.sample(count, {{"kind", kind}});
    text.gauge("a351_archive_records_waiting", "Records that could not be written yet.",
               status.at("counters").value(kWaiting, json()));
}

/// @param oven  "oven" or "outer_oven", key of the status and part of the names.
void tell_oven(Text& text, const json& status, const std::string& oven, std::string_view whose) {
    const json values = status.value(oven, json::object());
    text.gauge(fmt::format("a351_{}_heating_ratio", oven),
               "Heating power, as a part of full power.", values.value("heating_percent", json()),
               1e-2);
    text.metric(fmt::format("a351_{}_polls_total", oven), "counter",
                fmt::format("Polls of the {} controller, by outcome.", whose));
    const json polls = values.value("polls", json());
    for (const auto& [outcome, count] : polls.items()) text.sample(count, {{"outcome", outcome}});
}

void tell_surroundings(Text& text, const json& status) {
    text.metric("a351_temperature_celsius", "gauge",
                "Temperature of sensor and oven, and the oven's set point.");
    text.sample(at(status, "/sample/temperature_degc"), {{"at", "sensor"}});
    text.sample(at(status, "/oven/process_value_degc"), {{"at", "oven"}});
    text.sample(at(status, "/oven/set_point_degc"), {{"at", "set_point"}});
    const bool has_outer = status.contains("outer_oven");
    if (has_outer) {
        text.sample(at(status, "/outer_oven/process_value_degc"), {{"at", "outer_oven"}});
        text.sample(at(status, "/outer_oven/set_point_degc"), {{"at", "outer_set_point"}});
    }
    tell_oven(text, status, "oven", "oven's");
    if (has_outer) tell_oven(text, status, "outer_oven", "outer oven's");
    text.gauge("a351_disk_free_bytes", "Free disk space for the recorded data.",
               at(status, "/disk/free_bytes"));
    text.gauge("a351_longest_sync_seconds", "Longest time the journal waited for the disk.",
               at(status, "/disk/longest_sync_ms"), 1e-3);
}

void tell_use(Text& text, const PageUse& use) {
    text.gauge("a351_page_connections", "Open connections to the page, including live streams.",
               use.connections);
    text.gauge("a351_page_streams", "Open live streams.", use.streams);
    text.metric("a351_page_messages_dropped_total", "counter",
                "Messages not sent to viewers that read too slowly.");
    text.sample(use.messages_dropped);
    text.metric("a351_page_failures_total", "counter", "Answers that failed by an internal error.");
    text.sample(use.failures);
}

}  // namespace

std::string metrics_of(const json& status, const PageUse& use) {
    Text text;
    tell_state(text, status);
    tell_record(text, status);
    tell_surroundings(text, status);
    tell_use(text, use);
    return std::move(text.text_);
}

}  // namespace a351::daemon::page
