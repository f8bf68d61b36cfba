#include "protocol/events/event_log.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "protocol/text/json_text.hpp"

namespace a351::events {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_own_key(std::string_view key) {
    return key == "type" || key == "utc" || key == "session" || key == "index";
}

const std::string* text_at(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found == json.end() ? nullptr : found->get_ptr<const std::string*>();
}

bool ends_without_newline(const fs::path& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in || in.tellg() == std::streampos(0)) return false;
    in.seekg(-1, std::ios::end);
    return in.get() != '\n';
}

/// Removes a line that could not be synced, so that a refused event is not found later.
void take_back(files::FileLayer& files, const fs::path& file, std::uint64_t size) {
    try {
        files.truncate(file, size);
    } catch (const std::system_error&) {
        // The first error is the one to report.
    }
}

bool is_unique(const Event& event) {
    return event.type == "start" || event.type == "stop" || event.type == "setup";
}

/// Returns which lines of a month a merged copy of a data root has again.
///
/// The recorder never logs two equal starts, stops or set-ups.  Equal changes of a stay are possible,
/// as discard, restore, discard without a sensor: such a line counts as repeated only in a sequence
/// of repeated lines that has a start, stop or set-up.
std::vector<bool> find_repeated(const std::vector<std::string>& lines,
                                const std::vector<std::optional<Event>>& events) {
    std::vector<bool> is_repeated(lines.size());
    std::unordered_map<std::string_view, std::size_t> first;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!events[i] || !is_unique(*events[i]) || is_repeated[i]) continue;
        const auto [original, is_new] = first.emplace(lines[i], i);
        if (is_new) continue;
        const std::size_t distance = i - original->second;
        const auto repeats = [&](std::size_t at) {
            return at >= distance && at < lines.size() && !is_repeated[at] &&
                   !is_repeated[at - distance] && lines[at] == lines[at - distance];
        };
        std::size_t begin = i;
        while (begin > 0 && repeats(begin - 1)) --begin;
        for (std::size_t at = begin; at <= i || repeats(at); ++at) is_repeated[at] = true;
    }
    return is_repeated;
}

}  // namespace

std::string Event::detail(const std::string& key) const {
    const auto found = details.find(key);
    return found == details.end() ? std::string() : found->second;
}

std::string to_json(const Event& event) {
    Json json = {{"type", event.type}, {"utc", to_rfc3339(event.utc, 9)}};
    if (event.session) json["session"] = event.session->to_hex();
    if (event.index) json["index"] = *event.index;
    for (const auto& [key, value] : event.details) {
        if (is_own_key(key)) throw std::invalid_argument("event: detail named " + key);
        json[key] = value;
    }
    return text::json_text(json);
}

std::optional<Event> parse_event(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    const std::string* type = text_at(json, "type");
    const std::string* utc = text_at(json, "utc");
    if (!type || type->empty() || !utc) return std::nullopt;
    const auto time = parse_rfc3339(*utc);
    if (!time) return std::nullopt;
    Event event;
    event.type = *type;
    event.utc = *time;
    if (json.contains("session")) {
        const std::string* session = text_at(json, "session");
        if (session) event.session = journal::SessionId::from_hex(*session);
        if (!event.session) return std::nullopt;
    }
    if (const auto index = json.find("index"); index != json.end()) {
        const auto* number = index->get_ptr<const Json::number_integer_t*>();
        if (!number) return std::nullopt;
        event.index = *number;
    }
    for (const auto& [key, value] : json.items()) {
        if (is_own_key(key)) continue;
        if (!value.is_string()) return std::nullopt;
        event.details[key] = value.get<std::string>();
    }
    return event;
}

void append_event(files::FileLayer& files, const fs::path& directory, const Event& event) {
    const auto path = directory / (to_rfc3339(event.utc).substr(0, 7) + ".jsonl");
    if (!fs::exists(path)) files.create_directories(directory);
    // The new line must not be joined to one torn by a crash.
    std::string line = ends_without_newline(path) ? "\n" : "";
    line += to_json(event);
    line += '\n';
    const auto file = files.open_append(path);
    const std::uint64_t size_before = file->size();
    try {
        file->append(std::as_bytes(std::span(line)));
        file->sync();
        // Always, because a program that made the file may have been killed before this.
        files.sync_directory(directory);
    } catch (const std::system_error&) {
        take_back(files, path, size_before);
        throw;
    }
}

EventLog read_events(const fs::path& directory) {
    EventLog log;
    if (!fs::is_directory(directory)) return log;
    std::vector<fs::path> months;
    for (const auto& entry : fs::directory_iterator(directory)) {
        if (files::has_shape(entry.path().filename().string(), "####-##.jsonl"))
            months.push_back(entry.path());
    }
    std::ranges::sort(months);
    for (const auto& month : months) {
        std::ifstream in(month, std::ios::binary);
        if (!in) throw std::system_error(errno, std::generic_category(), "open " + month.string());
        std::vector<std::string> lines;
        std::vector<std::optional<Event>> events;
        for (std::string line; std::getline(in, line); lines.push_back(std::move(line)))
            events.push_back(parse_event(line));
        const std::vector<bool> is_repeated = find_repeated(lines, events);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (!events[i]) log.damage.push_back({month, i + 1});
            if (events[i] && !is_repeated[i]) log.events.push_back(std::move(*events[i]));
        }
    }
    return log;
}

}  // namespace a351::events
