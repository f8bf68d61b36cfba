#pragma once
/// @file
/// TOML read strictly: a key of the file that the program never asked for is an error.
/// Each error is an InputError `file:line: key = value: trouble; allowed: ...`.
///
/// Read every key that is allowed, with its limits, then check that no other is there:
///
///     TomlTable root = read_toml("day.toml");
///     TomlTable survey = root.table("survey");
///     const std::string base = survey.string_or("base", "");
///     const double cutoff_s = survey.number_or("cutoff_s", 60.0, 10.0, 600.0);
///     survey.require_all_read();
///     root.require_all_read();
///
/// A misspelled key is therefore reported, and does not silently leave a default in force.  Keys
/// are case-sensitive.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace toml {
inline namespace v3 {
class table;
class node;
}  // namespace v3
}  // namespace toml

namespace a351::text {

/// Table of a TOML document that remembers which of its keys were read.
///
/// Each table keeps the whole document in memory, so it remains valid after the table from which it
/// came.  A copy has its own record of read keys.  One thread at a time may use a table, because
/// reading a key changes that record.
class TomlTable {
public:
    /// Returns the value of `key`; if it is absent, `fallback`, std::nullopt or an empty list.
    ///
    /// `low` and `high` are allowed values.  They limit the file only: a `fallback` may be outside.
    /// Each call marks the key as read, also an absent one, and makes it part of the list of
    /// allowed keys in require_all_read().
    /// @throws InputError  the key has another type; a number is outside [low, high] or not finite.
    [[nodiscard]] std::string string_or(std::string_view key, std::string fallback);
    [[nodiscard]] bool boolean_or(std::string_view key, bool fallback);
    /// Returns a whole number; `3.0` has another type.
    [[nodiscard]] std::int64_t integer_or(std::string_view key, std::int64_t fallback,
                                          std::int64_t low, std::int64_t high);
    /// Returns a number.  Here, in number() and in numbers() a whole number like `3` is one too.
    [[nodiscard]] double number_or(std::string_view key, double fallback, double low, double high);
    [[nodiscard]] std::optional<double> number(std::string_view key, double low, double high);
    /// Returns a number that must be there.
    /// @param allowed  what the refusal of an absent one names.
    [[nodiscard]] double required_number(std::string_view key, double low, double high,
                                         std::string_view allowed = "a number");
    /// Returns the elements of an array of strings.  An empty array gives the same as no key.
    [[nodiscard]] std::vector<std::string> strings(std::string_view key);
    /// Returns the elements of an array of numbers, each within [low, high].  An empty array gives
    /// the same as no key; has() separates the two.
    [[nodiscard]] std::vector<double> numbers(std::string_view key, double low, double high);

    /// Returns an instant, in UTC if no zone is written; std::nullopt when absent or "".
    ///
    /// The value is a string as parse_rfc3339_in_zone() reads it.  A date-time of TOML, which has
    /// no quotation marks, has another type.
    /// @throws InputError  the key has another type, or is not an instant.
    [[nodiscard]] std::optional<UtcTime> instant(std::string_view key);

    /// Returns string_or(); the value, `fallback` included, must be one of `allowed`.
    /// @throws InputError  it is not; the message lists `allowed`.
    [[nodiscard]] std::string choice_or(std::string_view key, std::string fallback,
                                        const std::vector<std::string>& allowed);

    /// Returns a path, relative to the directory of the file unless absolute; empty when absent
    /// or "".  Parts `.` and `..` are removed where possible.  Nothing needs to exist there.
    /// @throws InputError  the key has another type.
    [[nodiscard]] std::filesystem::path path_or_empty(std::string_view key);

    /// Returns the sub-table `key`; an empty one when absent.  An empty one gives the fallback of
    /// every key.  Call it once per key: each returned table counts only its own reads.
    /// @throws InputError  the key has another type.
    [[nodiscard]] TomlTable table(std::string_view key);

    /// Returns the array of tables `[[key]]`, in order; empty when absent.  Each of them needs its
    /// own call of require_all_read().
    /// @throws InputError  the key has another type.
    [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);

    /// Returns true if the file has the key.  This does not count as reading it.
    [[nodiscard]] bool has(std::string_view key) const;

    /// Throws the InputError about `key`, for rules that only the caller knows.
    /// @param trouble  what is wrong, in a few words: "no such site".
    /// @param allowed  what would be right, for example the list of names.
    /// @throws InputError  always.  It has the line of the key, or of the table if there is no such
    ///                     key.  If a key that was not read is similar to `key`, it is named.
    [[noreturn]] void refuse(std::string_view key, std::string_view trouble,
                             std::string_view allowed) const;

    /// Checks that every key of the table was read.  Call it once per table, after the last key;
    /// sub-tables need a call of their own.
    /// @throws InputError  names the first key that was not read, and the keys that are allowed.
    void require_all_read() const;

private:
    friend TomlTable parse_toml(std::string_view text, std::filesystem::path origin);
    struct Document;

    TomlTable(std::shared_ptr<const Document> document, const toml::table* table, std::string name);
    [[nodiscard]] const toml::node* find(std::string_view key);
    void refuse_misspelt(std::string_view right) const;
    [[nodiscard]] std::string dotted(std::string_view key) const;

    std::shared_ptr<const Document> document_;
    const toml::table* table_;  ///< Owned by document_; null for an absent table.
    std::string name_;          ///< Dotted path of this table; empty for the root.
    std::set<std::string, std::less<>> asked_;
};

/// Reads a TOML file.
/// @return the root table; a file without keys gives an empty one.
/// @throws InputError  the file cannot be read, or is not TOML (with the parser's line and reason).
[[nodiscard]] TomlTable read_toml(const std::filesystem::path& file);

/// Reads TOML from text in memory; `origin` is the file name shown in messages.  Relative paths of
/// path_or_empty() begin at the directory of `origin`.
/// @throws InputError  the text is not TOML (with the parser's line and reason).
[[nodiscard]] TomlTable parse_toml(std::string_view text, std::filesystem::path origin);

/// Returns the text as a TOML string, with its quotes.  Bytes that are not UTF-8 become U+FFFD;
/// parse_toml() gives back any other text (strict_toml_test.cpp).
[[nodiscard]] std::string toml_string(const std::string& text);

}  // namespace a351::text
