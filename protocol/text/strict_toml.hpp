#pragma once
/// @file
/// TOML read strictly: a key of the file that the program never asked for is an error.
/// Each error is an InputError `file:line: key = value: trouble; allowed: ...`.

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
class TomlTable {
public:
    /// Returns the value of `key`; if it is absent, `fallback`, std::nullopt or an empty list.
    /// @throws InputError  the key has another type; a number is outside [low, high] or not finite.
    [[nodiscard]] std::string string_or(std::string_view key, std::string fallback);
    [[nodiscard]] bool boolean_or(std::string_view key, bool fallback);
    [[nodiscard]] std::int64_t integer_or(std::string_view key, std::int64_t fallback,
                                          std::int64_t low, std::int64_t high);
    [[nodiscard]] double number_or(std::string_view key, double fallback, double low, double high);
    [[nodiscard]] std::optional<double> number(std::string_view key, double low, double high);
    [[nodiscard]] std::vector<std::string> strings(std::string_view key);
    [[nodiscard]] std::vector<double> numbers(std::string_view key, double low, double high);

    /// Returns an instant, in UTC if no zone is written; std::nullopt when absent or "".
    [[nodiscard]] std::optional<UtcTime> instant(std::string_view key);

    /// Returns string_or(); the value, `fallback` included, must be one of `allowed`.
    [[nodiscard]] std::string choice_or(std::string_view key, std::string fallback,
                                        const std::vector<std::string>& allowed);

    /// Returns a path, relative to the directory of the file unless absolute; empty when absent
    /// or "".
    [[nodiscard]] std::filesystem::path path_or_empty(std::string_view key);

    /// Returns the sub-table `key`; an empty one when absent.
    [[nodiscard]] TomlTable table(std::string_view key);

    /// Returns the array of tables `[[key]]`, in order; empty when absent.
    [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);

    [[nodiscard]] bool has(std::string_view key) const;

    /// Throws the InputError about `key`, for rules that only the caller knows.
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

    std::shared_ptr<const Document> document_;
    const toml::table* table_;  ///< Owned by document_; null for an absent table.
    std::string name_;          ///< Dotted path of this table; empty for the root.
    std::set<std::string, std::less<>> asked_;
};

/// Reads a TOML file.
/// @throws InputError  the file cannot be read, or is not TOML (with the parser's line and reason).
[[nodiscard]] TomlTable read_toml(const std::filesystem::path& file);

/// Reads TOML from text in memory; `origin` is the file name shown in messages.
[[nodiscard]] TomlTable parse_toml(std::string_view text, std::filesystem::path origin);

}  // namespace a351::text
