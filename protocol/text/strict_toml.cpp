#include "protocol/text/strict_toml.hpp"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/echo.hpp"
#include "protocol/text/json_text.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::text {

struct TomlTable::Document {
    std::filesystem::path origin;
    toml::table root;
};

namespace {

std::string position(const std::filesystem::path& origin, const toml::source_region& source) {
    return fmt::format("{}:{}", origin.string(), source.begin.line);
}

std::string as_written(const toml::node& node) {
    if (const auto* const number = node.as_floating_point()) return shortest(**number);
    std::ostringstream out;
    node.visit([&out](const auto& value) { out << value; });
    return echoed(out.str());
}

/// Returns a line of a text, without blanks before it; lines are counted from 1.
std::string_view line_of(std::string_view text, std::size_t number) {
    for (; number > 1; --number) {
        const std::size_t end = text.find('\n');
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    text = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return text;
}

/// Returns true if a key differs from another in a few letters: one of four, at least one.
bool is_misspelt(std::string_view key, std::string_view right) {
    // Levenshtein's distance: the least number of letters to add, leave out or replace.
    std::vector<std::size_t> row;  // to the first letter, the first two ... of `right`
    for (std::size_t k = 1; k <= right.size(); ++k) row.push_back(k);
    std::size_t whole = right.size();
    for (std::size_t i = 0; i < key.size(); ++i) {
        std::size_t corner = i;
        whole = i + 1;
        for (std::size_t k = 0; k < row.size(); ++k) {
            const std::size_t replaced = corner + (key[i] == right[k] ? 0 : 1);
            corner = row[k];
            row[k] = whole = std::min({replaced, whole + 1, row[k] + 1});
        }
    }
    return whole <= std::max<std::size_t>(1, right.size() / 4);
}

}  // namespace

TomlTable::TomlTable(std::shared_ptr<const Document> document, const toml::table* table,
                     std::string name)
    : document_(std::move(document)), table_(table), name_(std::move(name)) {}

const toml::node* TomlTable::find(std::string_view key) {
    asked_.emplace(key);
    return table_ == nullptr ? nullptr : table_->get(key);
}

bool TomlTable::has(std::string_view key) const {
    return table_ != nullptr && table_->contains(key);
}

void TomlTable::refuse(std::string_view key, std::string_view trouble,
                       std::string_view allowed) const {
    const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
    if (node == nullptr) refuse_misspelt(key);
    const toml::source_region nowhere{};
    const auto& source = node != nullptr     ? node->source()
                         : table_ != nullptr ? table_->source()
                                             : nowhere;
    std::string message = position(document_->origin, source) + ": ";
    if (!name_.empty()) message += name_ + ".";
    message += echoed(key);
    if (node != nullptr && !node->is_table() && !node->is_array_of_tables())
        message += " = " + as_written(*node);
    throw InputError(fmt::format("{}: {}; allowed: {}", message, trouble, allowed));
}

/// Throws the InputError about a key that is meant to be the absent `right`, if there is one.
void TomlTable::refuse_misspelt(std::string_view right) const {
    if (table_ == nullptr) return;
    for (const auto& [key, node] : *table_) {
        if (asked_.contains(key.str()) || !is_misspelt(key.str(), right)) continue;
        throw InputError(fmt::format("{}: {}{}{}: unknown key; did you mean {}?",
                                     position(document_->origin, node.source()), name_,
                                     name_.empty() ? "" : ".", echoed(key.str()), right));
    }
}

std::string TomlTable::string_or(std::string_view key, std::string fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) return fallback;
    if (!node->is_string()) refuse(key, "wrong type", "a string");
    return **node->as_string();
}

bool TomlTable::boolean_or(std::string_view key, bool fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) return fallback;
    if (!node->is_boolean()) refuse(key, "wrong type", "true or false");
    return **node->as_boolean();
}

std::int64_t TomlTable::integer_or(std::string_view key, std::int64_t fallback, std::int64_t low,
                                   std::int64_t high) {
    const toml::node* node = find(key);
    if (node == nullptr) return fallback;
    const std::string allowed = fmt::format("a whole number from {} to {}", low, high);
    if (!node->is_integer()) refuse(key, "wrong type", allowed);
    const std::int64_t value = **node->as_integer();
    if (value < low || value > high) refuse(key, "out of range", allowed);
    return value;
}

std::optional<double> TomlTable::number(std::string_view key, double low, double high) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::string allowed = fmt::format("a number from {:g} to {:g}", low, high);
    if (!node->is_number()) refuse(key, "wrong type", allowed);
    const double value = *node->value<double>();
    if (!(value >= low && value <= high)) refuse(key, "out of range", allowed);
    return value;
}

double TomlTable::required_number(std::string_view key, double low, double high,
                                  std::string_view allowed) {
    const auto value = number(key, low, high);
    if (!value) refuse(key, "missing", allowed);
    return *value;
}

double TomlTable::number_or(std::string_view key, double fallback, double low, double high) {
    return number(key, low, high).value_or(fallback);
}

std::vector<std::string> TomlTable::strings(std::string_view key) {
    std::vector<std::string> values;
    const toml::node* node = find(key);
    if (node == nullptr) return values;
    if (!node->is_array()) refuse(key, "wrong type", "an array of strings");
    for (const toml::node& item : *node->as_array()) {
        if (!item.is_string()) refuse(key, "wrong type", "an array of strings");
        values.push_back(**item.as_string());
    }
    return values;
}

std::vector<double> TomlTable::numbers(std::string_view key, double low, double high) {
    std::vector<double> values;
    const toml::node* node = find(key);
    if (node == nullptr) return values;
    const std::string allowed = fmt::format("an array of numbers from {:g} to {:g}", low, high);
    if (!node->is_array()) refuse(key, "wrong type", allowed);
    for (const toml::node& item : *node->as_array()) {
        if (!item.is_number()) refuse(key, "wrong type", allowed);
        const double value = *item.value<double>();
        if (!(value >= low && value <= high)) refuse(key, "out of range", allowed);
        values.push_back(value);
    }
    return values;
}

std::optional<UtcTime> TomlTable::instant(std::string_view key) {
    const std::string value = string_or(key, "");
    if (value.empty()) return std::nullopt;
    const auto time = parse_rfc3339_in_zone(value, std::chrono::minutes(0));
    if (!time) refuse(key, "not an instant", "\"YYYY-MM-DDThh:mm:ssZ\"");
    return time;
}

std::string TomlTable::choice_or(std::string_view key, std::string fallback,
                                 const std::vector<std::string>& allowed) {
    std::string value = string_or(key, std::move(fallback));
    if (std::ranges::count(allowed, value) == 0) refuse(key, "not a known value", joined(allowed));
    return value;
}

std::filesystem::path TomlTable::path_or_empty(std::string_view key) {
    const std::string value = string_or(key, "");
    if (value.empty()) return {};
    return (document_->origin.parent_path() / value).lexically_normal();
}

/// Returns the path of a key of this table from the root.
std::string TomlTable::dotted(std::string_view key) const {
    return name_.empty() ? std::string(key) : name_ + "." + std::string(key);
}

TomlTable TomlTable::table(std::string_view key) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) refuse(key, "wrong type", "a table");
    return TomlTable(document_, node == nullptr ? nullptr : node->as_table(), dotted(key));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
    std::vector<TomlTable> tables;
    const toml::node* node = find(key);
    if (node == nullptr) return tables;
    if (!node->is_array_of_tables()) refuse(key, "wrong type", "an array of tables");
    for (const toml::node& item : *node->as_array())
        tables.push_back(TomlTable(document_, item.as_table(), dotted(key)));
    return tables;
}

void TomlTable::require_all_read() const {
    if (table_ == nullptr) return;
    for (const std::string& key : asked_)
        if (!table_->contains(key)) refuse_misspelt(key);
    for (const auto& [key, node] : *table_) {
        if (!asked_.contains(key.str()))
            refuse(key.str(), "unknown key", joined({asked_.begin(), asked_.end()}));
    }
}

TomlTable parse_toml(std::string_view text, std::filesystem::path origin) {
    auto document = std::make_shared<TomlTable::Document>();
    document->origin = std::move(origin);
    try {
        document->root = toml::parse(text);
    } catch (const toml::parse_error& error) {
        // The value is not shown, because it can be a token.
        const std::string_view line = line_of(text, error.source().begin.line);
        throw InputError(fmt::format(
            "{}: not TOML: {}; the line begins {}; allowed: key = value, with texts in quotes",
            position(document->origin, error.source()), error.description(),
            echoed(line.substr(0, line.find('=')))));
    }
    const toml::table* const root = &document->root;
    return TomlTable(std::move(document), root, "");
}

TomlTable read_toml(const std::filesystem::path& file) {
    return parse_toml(read_text_file(file), file);
}

std::string toml_string(const std::string& text) {
    // The escapes of JSON are valid in TOML, but DEL must be escaped too.
    std::string result;
    for (const char c : json_text(nlohmann::json(text))) {
        if (c == '\x7f')
            result += "\\u007F";
        else
            result += c;
    }
    return result;
}

}  // namespace a351::text
