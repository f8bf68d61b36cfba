#include "daemon/page/metrics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "daemon/page/status_fields.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;

struct Label {
    std::string_view key;  ///< Empty: no label.
    std::string text;
};

class Text {
public:
    /// Begins a metric; its samples follow.
    void metric(std::string_view name, std::string_view type, std::string_view help) {
        name_ = name;
        text_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
    }
    /// Adds a sample of the metric; nothing if the value is not a number.
    void sample(const json& value, const Label& label = {}, double scale = 1.0) {
        if (!value.is_number()) return;
        text_ += name_;
        if (!label.key.empty())
            text_ += fmt::format("{{{}=\"{}\"}}", label.key, escaped(label.text));
        text_ += ' ' + (scale == 1.0 ? value : json(scale * value.get<double>())).dump() + '\n';
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

/// Returns true if an item of a table is a field of its own.
bool is_declared(const std::string& path) {
    return std::ranges::count(status_fields(), path, &Field::path) > 0;
}

/// Adds the samples of a field's metric.
void add_samples(Text& text, const Field& field, const json& value) {
    using As = Metric::As;
    const Metric& metric = field.metric;
    const auto label = [&](std::string_view word) { return Label{metric.key, std::string(word)}; };
    switch (metric.as) {
        case As::number:
            text.sample(value, label(metric.label), metric.scale);
            break;
        case As::items:
            for (const auto& [name, count] : value.items())
                if (!is_declared(field.path + "/" + name)) text.sample(count, label(name));
            break;
        case As::states:
            for (const std::string_view state : metric.states)
                text.sample(value == state ? 1 : 0, label(state));
            break;
        case As::text:
            text.sample(1, label(value.get<std::string>()));
            break;
        case As::existence:
            text.sample(value.is_null() ? 0 : 1);
            break;
    }
}

/// Adds the metrics of the fields.  Fields with the same metric are samples of it.
void add_fields(Text& text, const json& status) {
    std::set<std::string> written;
    for (const Field& first : status_fields()) {
        const Metric& metric = first.metric;
        const auto is_sample = [&](const Field& field) {
            return field.metric.name == metric.name &&
                   status.contains(json::json_pointer(field.path));
        };
        if (metric.name.empty() || !written.insert(metric.name).second ||
            std::ranges::none_of(status_fields(), is_sample))
            continue;
        text.metric(metric.name, metric.name.ends_with("_total") ? "counter" : "gauge",
                    metric.help.empty() ? first.meaning : metric.help);
        for (const Field& field : status_fields())
            if (is_sample(field))
                add_samples(text, field, status.at(json::json_pointer(field.path)));
    }
}

void add_use(Text& text, const PageUse& use) {
    text.metric("a351_page_connections", "gauge",
                "Open connections to the page, including live streams.");
    text.sample(use.connections);
    text.metric("a351_page_streams", "gauge", "Open live streams.");
    text.sample(use.streams);
    text.metric("a351_page_messages_dropped_total", "counter",
                "Messages not sent to viewers that read too slowly.");
    text.sample(use.messages_dropped);
    text.metric("a351_page_failures_total", "counter", "Answers that failed by an internal error.");
    text.sample(use.failures);
}

}  // namespace

std::string metrics_of(const json& status, const PageUse& use) {
    Text text;
    add_fields(text, status);
    add_use(text, use);
    return std::move(text.text_);
}

}  // namespace a351::daemon::page
