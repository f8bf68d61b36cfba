#include "corrector/result/column.hpp"

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
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
                                 [](const std::string& text) { return text; }},
                      cell);
}

nlohmann::ordered_json json_value(const Cell& cell) {
    return std::visit(Overloaded{[](std::monostate) { return nlohmann::ordered_json(nullptr); },
                                 [](const auto& value) { return nlohmann::ordered_json(value); }},
                      cell);
}

}  // namespace a351::corrector
