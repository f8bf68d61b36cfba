#pragma once

#include <optional>
#include <string>

namespace a351::corrector {

/// A picture of gnuplot as an element of an HTML page: without declaration, description and size
/// (it takes the width of its place), its ids made its own by `prefix`, so that several pictures
/// share a page.
/// @return std::nullopt when it is no well-formed SVG.
[[nodiscard]] std::optional<std::string> inline_svg(const std::string& svg,
                                                    const std::string& prefix);

}  // namespace a351::corrector
