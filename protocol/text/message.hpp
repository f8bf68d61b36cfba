#pragma once
/// @file
/// Sentences for people, which can be translated after they were made.
///
///     Message reason = message("the box was moved at {}", time);
///     reason += message("; stop it");
///     log(reason);                          // English, as std::string
///     show(in_words(reason));               // the language of the program
///     json["message"] = reason.to_json();   // the texts with their arguments, for another program

#include <fmt/core.h>

#include <algorithm>
#include <concepts>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "protocol/text/catalogue.hpp"

namespace a351::text {

/// A sentence of several parts.  A part is an English text of the catalogue with its arguments, or a
/// text that is not translated: a name, a number, a message of the system.
class Message {
public:
    Message() = default;
    Message(std::string plain);                                       // NOLINT(*-explicit-*)
    Message(std::string_view plain) : Message(std::string(plain)) {}  // NOLINT(*-explicit-*)
    Message(const char* plain) : Message(std::string(plain)) {}       // NOLINT(*-explicit-*)
    /// @param text       in English, a key of the catalogue; arguments have their places as in fmt.
    /// @param arguments  formatted.
    Message(std::string_view text, std::vector<Message> arguments);

    Message& operator+=(const Message& end);
    [[nodiscard]] friend Message operator+(Message begin, const Message& end) {
        return begin += end;
    }
    [[nodiscard]] bool operator==(const Message& other) const { return english_ == other.english_; }
    template <std::convertible_to<std::string_view> Text>
    [[nodiscard]] friend bool operator==(const Message& one, const Text& english) {
        return one.english_ == english;
    }

    [[nodiscard]] const std::string& english() const noexcept { return english_; }
    operator const std::string&() const noexcept { return english_; }  // NOLINT(*-explicit-*)
    [[nodiscard]] bool empty() const noexcept { return english_.empty(); }
    [[nodiscard]] std::string in(Language language) const;

    /// Returns an array with one item per part: a string if it is not translated, else an array of its
    /// text and arguments, which are such arrays themselves.
    [[nodiscard]] nlohmann::json to_json() const;

private:
    struct Part {
        std::string text;
        std::vector<Message> arguments{};
        bool is_plain = false;
    };

    std::string english_;
    std::vector<Part> parts_;
};

/// Returns the sentence that such a JSON array describes.
/// @param english  used instead of an array of another form.
[[nodiscard]] Message parse_message(const nlohmann::json& parts, std::string_view english);

/// Returns the specification of an argument's place in a text, as {:.1f} for "{} of {:.1f}" and 1.
[[nodiscard]] std::string place_of(std::string_view text, std::size_t argument);

/// Returns the message with its arguments in the language of this program.
[[nodiscard]] inline std::string in_words(const Message& message) { return message.in(language()); }

/// Returns messages one by one, in the language of this program or in English.
[[nodiscard]] std::vector<std::string> each_in_words(const std::vector<Message>& messages);
[[nodiscard]] std::vector<std::string> in_english(const std::vector<Message>& messages);

/// Returns messages in the language of this program, with a separator between two.
[[nodiscard]] std::string in_words(const std::vector<Message>& messages,
                                   std::string_view separator);

}  // namespace a351::text

/// A message as an argument of another text; its place has no width.
template <>
struct fmt::formatter<a351::text::Message> {
    constexpr auto parse(fmt::format_parse_context& context) { return context.begin(); }
    template <class Context>
    auto format(const a351::text::Message& message, Context& context) const {
        return std::copy(message.english().begin(), message.english().end(), context.out());
    }
};

namespace a351::text {

namespace detail {

template <class Argument>
Message formatted(std::string_view text, std::size_t place, const Argument& argument) {
    if constexpr (std::is_same_v<Argument, Message>)
        return argument;
    else
        return Message(fmt::format(fmt::runtime(place_of(text, place)), argument));
}

template <class... Arguments, std::size_t... Places>
Message message(std::string_view text, std::index_sequence<Places...>,
                const Arguments&... arguments) {
    return {text, {formatted(text, Places, arguments)...}};
}

}  // namespace detail

/// Makes a sentence of a text of the catalogue, which is a literal with arguments as in fmt.
template <class... Arguments>
[[nodiscard]] Message message(fmt::format_string<const Arguments&...> text,
                              const Arguments&... arguments) {
    const fmt::string_view key = text;
    return detail::message(std::string_view(key.data(), key.size()),
                           std::index_sequence_for<Arguments...>(), arguments...);
}

/// Returns such a sentence in the language of this program.
template <class... Arguments>
[[nodiscard]] std::string tr(fmt::format_string<const Arguments&...> text,
                             const Arguments&... arguments) {
    return in_words(message(text, arguments...));
}

/// Returns a marked text as a message without arguments.
[[nodiscard]] inline Message marked_message(std::string_view text) { return {text, {}}; }

}  // namespace a351::text
