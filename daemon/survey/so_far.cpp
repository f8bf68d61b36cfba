#include "daemon/survey/so_far.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace a351::daemon::survey {
namespace {

using nlohmann::json;

std::string text_of(const json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<MilliGal> value_of(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    return MilliGal(found->get<double>());
}

const json& list_of(const json& document, const char* key) {
    static const json kNone = json::array();
    const auto found = document.find(key);
    return found != document.end() && found->is_array() ? *found : kNone;
}

std::vector<Contradiction> contradictions_in(const json& document, const char* member) {
    std::vector<Contradiction> all;
    for (const json& one : list_of(document, member)) {
        if (!one.is_object()) continue;
        all.push_back({text_of(one, "code"),
                       text_of(one, "key"),
                       text::parse_message(one.value("text_parts", json()), text_of(one, "text")),
                       {kChecked}});
    }
    return all;
}

constexpr const char* kEvent = "contradiction";

}  // namespace

SoFarReader::SoFarReader(const std::vector<events::Event>& events,
                         std::function<void(const events::Event&)> note)
    : note_(std::move(note)) {
    for (const events::Event& event : events) {
        const std::string key = event.detail("key"), code = event.detail("code");
        if (event.type != kEvent || key.empty()) continue;
        if (code.empty())
            said_.erase(key);
        else
            said_[key] = code;
    }
}

SoFar SoFarReader::read(std::string_view document) {
    SoFar so_far;
    const json read = json::parse(document, nullptr, false);
    if (!read.is_object()) return so_far;
    for (const json& stay : list_of(read, "stays")) {
        if (!stay.is_object()) continue;
        StayGravity& one = so_far.stays[text_of(stay, "key")];
        one.gravity = value_of(stay, "gravity_mgal");
        one.u = value_of(stay, "u_mgal");
        if (!one.gravity && stay.contains("missing_parts"))
            one.missing = text::parse_message(stay.at("missing_parts"), "");
    }
    so_far.contradictions = contradictions_in(read, "contradictions");
    Codes still;
    for (const Contradiction& one : so_far.contradictions)
        if (!one.key.empty()) still[one.key] = one.code;
    for (Contradiction& one : contradictions_in(read, "lesser_contradictions")) {
        const auto before = said_.find(one.key);
        if (before == said_.end()) continue;
        still.insert(*before);
        one.code = before->second;
        so_far.contradictions.push_back(std::move(one));
    }
    const bool has_figures =
        text_of(read, "reason").empty() && read.contains("lesser_contradictions");
    if (has_figures)  // Without figures nothing is known to have ended.
        keep(std::move(still), parse_rfc3339(text_of(read, "data_to_utc")));
    return so_far;
}

/// Replaces the contradictions that stay, and logs each that begins, has another code or ends.
/// @param data_end  end of the data of these figures; absent: nothing is logged.
void SoFarReader::keep(Codes codes, const std::optional<UtcTime>& data_end) {
    const auto log = [&](const std::string& key, const std::string& code) {
        if (!data_end) return;
        events::Event event{kEvent, *data_end, {}, {}, {{"key", key}}};
        if (!code.empty()) event.details["code"] = code;
        note_(event);
    };
    for (const auto& [key, code] : codes)
        if (const auto before = said_.find(key); before == said_.end() || before->second != code)
            log(key, code);
    for (const auto& [key, code] : said_)
        if (!codes.contains(key)) log(key, "");
    said_ = std::move(codes);
}

}  // namespace a351::daemon::survey
