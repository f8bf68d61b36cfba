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

}  // namespace

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
    std::map<std::string, std::string> still;
    for (const Contradiction& one : so_far.contradictions)
        if (!one.key.empty()) still[one.key] = one.code;
    for (Contradiction& one : contradictions_in(read, "lesser_contradictions")) {
        const auto before = said_.find(one.key);
        if (before == said_.end()) continue;
        still.insert(*before);
        one.code = before->second;
        so_far.contradictions.push_back(std::move(one));
    }
    if (read.contains("lesser_contradictions")) said_ = std::move(still);  // New figures.
    return so_far;
}

}  // namespace a351::daemon::survey
