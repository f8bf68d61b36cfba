#pragma once
/// @file
/// TOML read strictly: every key is asked for once, and one that nobody asked for is an error.
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

/// A table of a TOML document that remembers which of its keys were read.
class TomlTable {
public:
    /// The value of `key`, or `fallback` when it is absent.
    /// @throws InputError  the key has another type; a number outside [low, high]; not finite.
    [[nodiscard]] std::string string_or(std::string_view key, std::string fallback);
    [[nodiscard]] bool boolean_or(std::string_view key, bool fallback);
    [[nodiscard]] std::int64_t integer_or(std::string_view key, std::int64_t fallback,
                                          std::int64_t low, std::int64_t high);
    [[nodiscard]] double number_or(std::string_view key, double fallback, double low, double high);
    [[nodiscard]] std::optional<double> number(std::string_view key, double low, double high);
    [[nodiscard]] std::vector<std::string> strings(std::string_view key);
    [[nodiscard]] std::vector<double> numbers(std::string_view key, double low, double high);

    /// An instant, in UTC where no zone is written; std::nullopt when absent or "".
    [[nodiscard]] std::optional<UtcTime> instant(std::string_view key);

    /// As string_or, and the value must be one of `allowed`.
    [[nodiscard]] std::string choice_or(std::string_view key, std::string fallback,
                                        const std::vector<std::string>& allowed);

    /// A path, relative to the directory of the file unless absolute; empty when absent or "".
    [[nodiscard]] std::filesystem::path path_or_empty(std::string_view key);

    /// The sub-table `key`; an empty one when absent.
    [[nodiscard]] TomlTable table(std::string_view key);

    /// The array of tables `[[key]]`, in order; empty when absent.
    [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);

    [[nodiscard]] bool has(std::string_view key) const;

    /// Throws the InputError about `key`, for rules that only the caller knows.
    [[noreturn]] void refuse(std::string_view key, std::string_view trouble,
                             std::string_view allowed) const;

    /// Call once per table, after the last key was asked for; sub-tables answer for themselves.
    /// @throws InputError  naming the first key that was never asked for, and those that exist.
    void require_all_read() const;

private:
    friend TomlTable parse_toml(std::string_view text, std::filesystem::path origin);
    struct Document;

    TomlTable(std::shared_ptr<const Document> document, const toml::table* table, std::string name);
    [[nodiscard]] const toml::node* find(std::string_view key);

    std::shared_ptr<const Document> document_;
    const toml::table* table_;  ///< Owned by document_; null stands for an absent table.
    std::string name_;          ///< Dotted path of this table; empty for the root.
    std::set<std::string, std::less<>> asked_;
};

/// @throws InputError  the file cannot be read, or is not TOML (with the parser's line and reason).
[[nodiscard]] TomlTable read_toml(const std::filesystem::path& file);

/// The same from text in memory; `origin` stands for the file name in messages.
[[nodiscard]] TomlTable parse_toml(std::string_view text, std::filesystem::path origin);

}  // namespace a351::text
