#pragma once
/// @file
/// Numbers, lists and tables as text for people.
///
/// Use these functions for reports and messages, where the number of decimals is a choice.  Do not
/// use them for numbers that a program reads again: shortest() of csv.hpp loses nothing.
///
///     aligned({{"site", "mGal"}, {"No.0", fixed(0.123, 2)}, {"No.10", fixed(-1.5, 2)}})
///
///     site    mGal
///     No.0    0.12
///     No.10  -1.50
///
/// The texts do not depend on the locale.  Arguments are not checked.

#include <optional>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::text {

/// Returns `value` as text with `decimals` digits after the point, in any locale; never "-0".
///
/// The value is rounded to the nearest text and never written with an exponent: 1e300 has 301
/// digits.  A result that rounds to zero has no sign.  NaN gives "nan" or "-nan", infinity "inf" or
/// "-inf".
/// @param decimals  0 to 80; 0 gives no point.
[[nodiscard]] std::string fixed(double value, int decimals);

/// Returns the digits after the point that a value with this uncertainty deserves: one more than
/// its first digit.  1.5 gives 1, 0.94 gives 2, 31 gives 0.
/// @param u_mgal  absent or not above 0: 1 digit.
[[nodiscard]] int decimals_for(const std::optional<double>& u_mgal);

/// Returns fixed(), or `absent` if there is no value.  A MilliGal is written in mGal, without the
/// unit.
/// @param decimals  as fixed().
/// @param absent    text for a missing value, for example "-" or "".
[[nodiscard]] std::string fixed_or(const std::optional<double>& value, int decimals,
                                   const std::string& absent);
[[nodiscard]] std::string fixed_or(const std::optional<MilliGal>& value, int decimals,
                                   const std::string& absent);

/// Returns the texts, joined by `separator`.  No texts give "".  Empty texts at the beginning get
/// no separator; later ones do.
[[nodiscard]] std::string joined(const std::vector<std::string>& texts,
                                 const std::string& separator = ", ");

/// Returns a table as text, one line per row.  Columns are as wide as their widest cell; the first
/// is aligned left, the others right.
///
/// Two blanks separate the columns.  A line has no blanks at its end; each line ends with LF, also
/// the last.  The width of a cell is that on a terminal, where letters from U+3000 on count as two
/// (columns_of()).
/// @param rows  at least one, all of the same length.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

}  // namespace a351::text
