#pragma once
/// @file
/// Pictures within an HTML page.

#include <optional>
#include <string>

namespace a351::corrector {

/// Converts a picture of gnuplot to an element of an HTML page, without declaration, description
/// and size; it takes the width of its place.
/// @param prefix  of its ids, so that several pictures can be in one page.
/// @return std::nullopt if it is no well-formed SVG.
[[nodiscard]] std::optional<std::string> inline_svg(const std::string& svg,
                                                    const std::string& prefix);

}  // namespace a351::corrector
