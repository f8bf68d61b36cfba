#include "daemon/page/so_far.hpp"

#include <nlohmann/json.hpp>

namespace a351::daemon::page {
namespace {

using nlohmann::json;

std::string text_of(const json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

const json& list_of(const json& document, const char* key) {
    static const json kNone = json::array();
    const auto found = document.find(key);
    return found != document.end() && found->is_array() ? *found : kNone;
}

}  // namespace

SoFar read_so_far(std::string_view document) {
    SoFar so_far;
    const json read = json::parse(document, nullptr, false);
    if (!read.is_object()) return so_far;
    for (const json& stay : list_of(read, "stays")) {
        if (!stay.is_object()) continue;
        json& one = so_far.stays[text_of(stay, "key")];
        for (const char* const name : {"gravity_mgal", "u_mgal", "missing_parts"})
            one[name] = stay.value(name, json());
    }
    for (const json& one : list_of(read, "contradictions")) {
        if (!one.is_object()) continue;
        so_far.contradictions.push_back(
            {text_of(one, "code"),
             text_of(one, "key"),
             text::parse_message(one.value("text_parts", json()), text_of(one, "text")),
             {survey::kChecked}});
    }
    return so_far;
}

}  // namespace a351::daemon::page
