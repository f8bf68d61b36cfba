#pragma once
/// @file
/// Pictures within an HTML page.
///
/// A page with its pictures inside is one file that can be sent and archived.  The price is its
/// size: text and data of every picture are in it.

#include <pugixml.hpp>
#include <string>

namespace a351::corrector::figure {

/// Adds a picture of gnuplot to a node of a page, without declaration, description and size; it
/// takes the width of its place.
///
/// References to ids within the picture get the same prefix: xlink:href="#X" and values that begin
/// with url(#X).  Titles of the plots are removed, which a browser would show under the mouse.
///
/// Only pictures that this program made with gnuplot are meant: scripts in an SVG are not removed.
/// @param parent  without children.
/// @param svg     whole content of the file, UTF-8.
/// @param prefix  of its ids, so that several pictures can be in one page; letters, digits and '-'.
/// @return false if it is no well-formed SVG, or if its root element has no viewBox; then nothing
///         is added.
[[nodiscard]] bool add_svg(pugi::xml_node parent, const std::string& svg,
                           const std::string& prefix);

}  // namespace a351::corrector::figure
