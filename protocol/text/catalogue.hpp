#pragma once
/// @file
/// Translations of the texts that people read.  English is the source text in the code and the key of
/// the catalogue; the catalogue of a language is a .po file, which the build compiles into the
/// programs.  The C library's locales are not used: they must be installed on the host, and numbers
/// would change with them.

#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace a351::text {

/// English, or a language with a catalogue.
struct Language {
    static const Language english;

    std::string_view code = "en";     ///< Code of the language by ISO 639-1.
    std::string_view catalogue = {};  ///< The .mo file that msgfmt made; empty: English.

    [[nodiscard]] bool operator==(const Language& other) const { return code == other.code; }
};
inline constexpr Language Language::english{};

/// Returns the languages with a catalogue, in the order of protocol/text/CMakeLists.txt.
[[nodiscard]] std::span<const Language> other_languages() noexcept;

/// Returns the name of a language in itself.
[[nodiscard]] std::string_view name_of(Language language) noexcept;

/// Returns the language of a code such as "ja", or of a locale such as "ja_JP.UTF-8"; std::nullopt if
/// there is no catalogue for it.
[[nodiscard]] std::optional<Language> parse_language(std::string_view locale) noexcept;

/// Returns the language that the first of A351_LANG, LC_ALL, LC_MESSAGES and LANG names which is set
/// and not empty.  English, if there is no catalogue for it.
[[nodiscard]] Language language_of_environment() noexcept;

/// Sets the language in which this program writes to people, at first English.  Call it before the
/// first text, and never while other threads run.  language() returns it.
void write_in(Language language) noexcept;
[[nodiscard]] Language language() noexcept;

/// Returns the translation of an English text; the text itself if there is none.
[[nodiscard]] std::string_view translated(std::string_view english, Language language) noexcept;
/// Returns the translation into the language of this program.
[[nodiscard]] inline std::string translated(std::string_view english) {
    return std::string(translated(english, language()));
}

/// Returns all texts of a catalogue with their translations, in the order of the texts.
[[nodiscard]] std::vector<std::pair<std::string_view, std::string_view>> catalogue(
    Language language);

/// Returns the text itself.  It marks a text for the catalogue (update_catalogue.py) at a place
/// where the text is not translated yet, for example in a table of constants.
[[nodiscard]] constexpr const char* marked(const char* text) noexcept { return text; }

}  // namespace a351::text
