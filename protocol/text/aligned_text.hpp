#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::text {

/// Returns `value` as text with `decimals` digits after the point, in any locale; never "-0".
[[nodiscard]] std::string fixed(double value, int decimals);

/// Returns fixed(), or `absent` if there is no value.
[[nodiscard]] std::string fixed_or(const std::optional<double>& value, int decimals,
                                   const std::string& absent);
[[nodiscard]] std::string fixed_or(const std::optional<MilliGal>& value, int decimals,
                                   const std::string& absent);

/// Returns the texts, joined by `separator`.
[[nodiscard]] std::string joined(const std::vector<std::string>& texts,
                                 const std::string& separator = ", ");

/// Returns a table as text, one line per row.  Columns are as wide as their widest cell; the first
/// is aligned left, the others right.
/// @param rows  at least one, all of the same length.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

}  // namespace a351::text
