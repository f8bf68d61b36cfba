#include "protocol/text/decimal_sign.hpp"

#include <algorithm>
#include <string>

#include "protocol/text/csv_lines.hpp"
#include "protocol/text/csv_reader.hpp"

namespace a351::text {
namespace {

/// A number with a sign between its digits.
struct SignedNumber {
    char sign = '\0';          ///< '.' or ','; '\0' if the text is not such a number.
    bool is_doubtful = false;  ///< The comma may stand between thousands: 1,234.
};

SignedNumber signed_number(std::string_view text) {
    constexpr std::string_view kDigits = "0123456789";
    constexpr std::size_t kGroup = 3;
    if (text.starts_with('-')) text.remove_prefix(1);
    const std::size_t sign = text.find_first_not_of(kDigits);
    if (sign == std::string_view::npos || (text[sign] != '.' && text[sign] != ',')) return {};
    const std::string_view rest = text.substr(sign + 1);
    const std::size_t end = std::min(rest.find_first_not_of(kDigits), rest.size());
    if (end == 0 || (end < rest.size() && rest[end] != 'e' && rest[end] != 'E')) return {};
    const bool is_group =
        sign > 0 && sign <= kGroup && end == kGroup && end == rest.size() && text.front() != '0';
    return {text[sign], text[sign] == ',' && is_group};
}

std::string with_usual_minus(std::string_view text) {
    constexpr std::string_view kMinus = "\xE2\x88\x92";
    return text.starts_with(kMinus) ? "-" + std::string(text.substr(kMinus.size()))
                                    : std::string(text);
}

}  // namespace

bool DecimalSign::note(std::string_view cell) {
    const SignedNumber found = signed_number(with_usual_minus(cell));
    if (found.sign == '\0' || found.sign == sign_) return true;
    if (sign_ != '\0') return false;
    if (!found.is_doubtful) sign_ = found.sign;
    return true;
}

std::optional<double> DecimalSign::number(std::string_view cell) const {
    if (const auto number = parse_number(cell)) return number;
    std::string text = with_usual_minus(cell);
    const SignedNumber found = signed_number(text);
    if (found.sign == ',') {
        if (found.is_doubtful && sign_ != ',') return std::nullopt;
        std::ranges::replace(text, ',', '.');
    }
    return parse_number(text);
}

std::string_view DecimalSign::remedy(std::string_view cell) {
    const bool is_like_number = cell.find_first_of("0123456789") != std::string_view::npos &&
                                cell.find_first_not_of("-0123456789., '") == std::string_view::npos;
    return is_like_number && cell.find_first_of(", '") != std::string_view::npos
               ? kHowToSave
               : std::string_view();
}

}  // namespace a351::text
