#include "corrector/result/column.hpp"

#include <nlohmann/json.hpp>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::result {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};

}  // namespace

std::string csv_text(const Cell& cell) {
    constexpr int kDecimals = 6;
    return std::visit(Overloaded{[](std::monostate) { return std::string(); },
                                 [](bool is_so) { return std::string(is_so ? "1" : "0"); },
                                 [](std::int64_t count) { return std::to_string(count); },
                                 [](double value) { return text::fixed(value, kDecimals); },
                                 [](const std::string& text) { return text; },
                                 [](UtcTime time) { return to_rfc3339(time, 3); }},
                      cell);
}

std::string shown_text(const Cell& cell, int decimals) {
    return std::visit(
        Overloaded{[](std::monostate) { return std::string("-"); },
                   [](bool is_so) { return is_so ? text::tr("yes") : text::tr("no"); },
                   [](std::int64_t count) { return std::to_string(count); },
                   [decimals](double value) { return text::fixed(value, decimals); },
                   [](const std::string& text) { return text; },
                   [](UtcTime time) { return to_rfc3339(time); }},
        cell);
}

std::string aligned_text(const Table& table) {
    std::vector<std::vector<std::string>> lines(1);
    for (const std::string& heading : table.headings)
        lines.front().emplace_back(text::translated(heading));
    lines.insert(lines.end(), table.rows.begin(), table.rows.end());
    return text::aligned(lines);
}

nlohmann::ordered_json json_value(const Cell& cell) {
    return std::visit(
        Overloaded{[](std::monostate) { return nlohmann::ordered_json(nullptr); },
                   [](UtcTime time) { return nlohmann::ordered_json(to_rfc3339(time, 3)); },
                   [](const auto& value) { return nlohmann::ordered_json(value); }},
        cell);
}

}  // namespace a351::corrector::result
