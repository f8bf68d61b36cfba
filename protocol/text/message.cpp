#include "protocol/text/message.hpp"

#include <nlohmann/json.hpp>

namespace a351::text {
namespace {

using nlohmann::json;

/// A place for an argument in a text: {}, {2}, {:.1f} or {2:.1f}.
struct Place {
    std::size_t begin = 0, end = 0;
    std::size_t argument = 0;
    std::string_view specification;  ///< With its colon; empty if there is none.
};

/// Returns the places of a text in their order.
std::vector<Place> places_of(std::string_view text) {
    std::vector<Place> places;
    for (std::size_t at = text.find('{'); at < text.size(); at = text.find('{', at)) {
        const std::size_t end = text.find('}', at);
        if (end == std::string_view::npos) break;
        const std::string_view inside = text.substr(at + 1, end - at - 1);
        const std::size_t colon = std::min(inside.find(':'), inside.size());
        Place place{at, end + 1, places.size(), inside.substr(colon)};
        if (colon > 0) {
            place.argument = 0;
            for (const char digit : inside.substr(0, colon))
                place.argument = 10 * place.argument + static_cast<std::size_t>(digit - '0');
        }
        places.push_back(place);
        at = end;
    }
    return places;
}

/// Returns a text with arguments at their places.
std::string filled(std::string_view text, const std::vector<std::string>& arguments) {
    std::string whole;
    std::size_t at = 0;
    for (const Place& place : places_of(text)) {
        whole += text.substr(at, place.begin - at);
        if (place.argument < arguments.size()) whole += arguments[place.argument];
        at = place.end;
    }
    return whole += text.substr(at);
}

}  // namespace

Message::Message(std::string plain) : english_(std::move(plain)) {
    if (!english_.empty()) parts_.push_back({english_, {}, true});
}

Message::Message(std::string_view text, std::vector<Message> arguments) {
    std::vector<std::string> words;
    for (const Message& one : arguments) words.push_back(one.english());
    english_ = filled(text, words);
    parts_.push_back({std::string(text), std::move(arguments)});
}

Message& Message::operator+=(const Message& end) {
    english_ += end.english_;
    parts_.insert(parts_.end(), end.parts_.begin(), end.parts_.end());
    return *this;
}

std::string Message::in(Language language) const {
    if (language == Language::english) return english_;
    std::string whole;
    for (const Part& part : parts_) {
        if (part.is_plain) {
            whole += part.text;
            continue;
        }
        std::vector<std::string> words;
        for (const Message& one : part.arguments) words.push_back(one.in(language));
        whole += filled(translated(part.text, language), words);
    }
    return whole;
}

json Message::to_json() const {
    json parts = json::array();
    for (const Part& part : parts_) {
        if (part.is_plain) {
            parts.push_back(part.text);
            continue;
        }
        json one = json::array({part.text});
        for (const Message& argument : part.arguments) one.push_back(argument.to_json());
        parts.push_back(std::move(one));
    }
    return parts;
}

Message parse_message(const json& parts, std::string_view english) {
    if (!parts.is_array()) return english;
    Message message;
    for (const json& part : parts) {
        if (part.is_string()) {
            message += part.get<std::string>();
        } else if (part.is_array() && !part.empty() && part.front().is_string()) {
            std::vector<Message> arguments;
            for (auto one = part.begin() + 1; one != part.end(); ++one)
                arguments.push_back(parse_message(*one, ""));
            message += Message(part.front().get_ref<const std::string&>(), std::move(arguments));
        } else {
            return english;
        }
    }
    return message;
}

std::string place_of(std::string_view text, std::size_t argument) {
    for (const Place& place : places_of(text))
        if (place.argument == argument) return "{" + std::string(place.specification) + "}";
    return "{}";
}

std::vector<std::string> each_in_words(const std::vector<Message>& messages) {
    std::vector<std::string> texts;
    for (const Message& one : messages) texts.push_back(in_words(one));
    return texts;
}

std::vector<std::string> in_english(const std::vector<Message>& messages) {
    std::vector<std::string> texts;
    for (const Message& one : messages) texts.push_back(one.english());
    return texts;
}

std::string in_words(const std::vector<Message>& messages, std::string_view separator) {
    std::string whole;
    for (const Message& one : messages) {
        if (!whole.empty()) whole += separator;
        whole += in_words(one);
    }
    return whole;
}

}  // namespace a351::text
