#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::text {

/// Decimal text with so many digits after the point, in any locale; no "-0".
[[nodiscard]] std::string fixed(double value, int decimals);

/// The same; `absent` where there is no value.
[[nodiscard]] std::string fixed_or(const std::optional<double>& value, int decimals,
                                   const std::string& absent);
[[nodiscard]] std::string fixed_or(const std::optional<MilliGal>& value, int decimals,
                                   const std::string& absent);

/// The texts one after the other.
[[nodiscard]] std::string joined(const std::vector<std::string>& texts,
                                 const std::string& separator = ", ");

/// Columns as wide as their widest cell; the first is aligned left, the others right.
/// @param rows  at least one, all of the same length.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& rows);

}  // namespace a351::text
