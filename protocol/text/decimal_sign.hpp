#pragma once

#include <optional>
#include <string_view>

namespace a351::text {

/// The decimal sign of the numbers in a table.  A spreadsheet writes a comma or a point, by the
/// language of its computer, and some put the other one between thousands.
///
/// The first number that can be read in one way only decides for the table.  1,234 can be read in
/// two ways, whatever separates the cells; 1.234 is a decimal point unless another number has a
/// decimal comma.
class DecimalSign {
public:
    /// Takes a cell into account; other text than a number changes nothing.
    /// @return false if the cell has the other sign than the numbers before it.
    [[nodiscard]] bool note(std::string_view cell);

    /// The sign found so far; '\0' while there is none.
    [[nodiscard]] char sign() const noexcept { return sign_; }

    /// Returns the finite number in a cell; std::nullopt if it is none, or can be read in two ways.
    /// A minus sign (U+2212) is read as -.
    [[nodiscard]] std::optional<double> number(std::string_view cell) const;

    /// Returns what a refusal of the cell adds: the remedy if it looks like a number with a comma,
    /// else an empty text.
    [[nodiscard]] static std::string_view remedy(std::string_view cell);

private:
    char sign_ = '\0';
};

}  // namespace a351::text
