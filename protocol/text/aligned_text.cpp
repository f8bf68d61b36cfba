#include "protocol/text/aligned_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "protocol/text/columns.hpp"

namespace a351::text {

std::string fixed(double value, int decimals) {
    char digits[400];  // the longest double has 309 digits before the point
    std::string text(digits, std::to_chars(digits, digits + sizeof digits, value,
                                           std::chars_format::fixed, decimals)
                                 .ptr);
    if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos)
        text.erase(0, 1);
    return text;
}

int decimals_for(const std::optional<double>& u_mgal) {
    if (!u_mgal || !(*u_mgal > 0.0)) return 1;
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(*u_mgal))), 0, 7);
}

std::string fixed_or(const std::optional<double>& value, int decimals, const std::string& absent) {
    return value ? fixed(*value, decimals) : absent;
}

std::string fixed_or(const std::optional<MilliGal>& value, int decimals,
                     const std::string& absent) {
    return value ? fixed(value->value(), decimals) : absent;
}

std::string joined(const std::vector<std::string>& texts, const std::string& separator) {
    std::string list;
    for (const std::string& text : texts) list.append(list.empty() ? "" : separator).append(text);
    return list;
}

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows) {
        for (std::size_t k = 0; k < row.size(); ++k)
            widths[k] = std::max(widths[k], columns_of(row[k]));
    }
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t k = 0; k < row.size(); ++k) {
            const std::string blanks(widths[k] - columns_of(row[k]), ' ');
            line += k == 0 ? row[k] + blanks : "  " + blanks + row[k];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    }
    return text;
}

}  // namespace a351::text
