#include "protocol/text/catalogue.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace a351::text {
namespace {

Language g_language = Language::english;

/// A .mo file: a header, two tables of lengths and offsets, and the texts in the order of their bytes.
/// Source: GNU gettext manual, "The Format of GNU MO Files".
class MoFile {
public:
    explicit constexpr MoFile(std::string_view bytes) : bytes_(bytes) {}

    [[nodiscard]] std::size_t size() const { return number_at(8); }
    [[nodiscard]] std::string_view english(std::size_t i) const { return text_at(12, i); }
    [[nodiscard]] std::string_view other(std::size_t i) const { return text_at(16, i); }

private:
    /// Returns a number of the file, which msgfmt writes with the lowest byte first.
    [[nodiscard]] std::size_t number_at(std::size_t place) const {
        std::size_t number = 0;
        for (std::size_t byte = 4; byte-- > 0;)
            number = number << 8U | static_cast<unsigned char>(bytes_[place + byte]);
        return number;
    }
    [[nodiscard]] std::string_view text_at(std::size_t table, std::size_t i) const {
        const std::size_t entry = number_at(table) + 8 * i;
        return bytes_.substr(number_at(entry + 4), number_at(entry));
    }

    std::string_view bytes_;
};

}  // namespace

std::optional<Language> parse_language(std::string_view locale) noexcept {
    const std::string_view code = locale.substr(0, locale.find_first_of("_.@-"));
    if (code == "en" || code == "C" || code == "POSIX") return Language::english;
    const auto found = std::ranges::find(other_languages(), code, &Language::code);
    return found == other_languages().end() ? std::nullopt : std::optional(*found);
}

Language language_of_environment() noexcept {
    for (const char* const name : {"A351_LANG", "LC_ALL", "LC_MESSAGES", "LANG"}) {
        const char* const value = std::getenv(name);
        if (value == nullptr || *value == '\0') continue;
        return parse_language(value).value_or(Language::english);
    }
    return Language::english;
}

void write_in(Language language) noexcept { g_language = language; }

Language language() noexcept { return g_language; }

std::string_view name_of(Language language) noexcept {
    // In a catalogue the translation of this word is the name of its own language.
    return translated(marked("English"), language);
}

std::string_view translated(std::string_view english, Language language) noexcept {
    // The empty text is the key of the catalogue's header.
    if (language == Language::english || english.empty()) return english;
    const MoFile file(language.catalogue);
    std::size_t low = 0, high = file.size();
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        const std::string_view found = file.english(middle);
        if (found == english) return file.other(middle);
        if (found < english)
            low = middle + 1;
        else
            high = middle;
    }
    return english;
}

std::vector<std::pair<std::string_view, std::string_view>> catalogue(Language language) {
    std::vector<std::pair<std::string_view, std::string_view>> texts;
    if (language == Language::english) return texts;
    const MoFile file(language.catalogue);
    for (std::size_t i = 0; i < file.size(); ++i)
        if (!file.english(i).empty()) texts.emplace_back(file.english(i), file.other(i));
    return texts;
}

}  // namespace a351::text
