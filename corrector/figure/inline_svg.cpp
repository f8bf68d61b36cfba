#include "corrector/figure/inline_svg.hpp"

#include <cstring>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>

namespace a351::corrector::figure {
namespace {

/// Adds the prefix to the ids, and to the references to them: id="X", xlink:href="#X" and
/// filter="url(#X)".
void own_ids(pugi::xml_node node, const std::string& prefix) {
    for (pugi::xml_attribute attribute : node.attributes()) {
        const std::string_view name = attribute.name();
        const std::string value = attribute.value();
        if (name == "id") {
            attribute.set_value((prefix + value).c_str());
        } else if (name == "xlink:href" && value.starts_with('#')) {
            attribute.set_value(('#' + prefix + value.substr(1)).c_str());
        } else if (value.starts_with("url(#")) {
            attribute.set_value(("url(#" + prefix + value.substr(5)).c_str());
        }
    }
    for (const pugi::xml_node child : node.children()) own_ids(child, prefix);
}

/// Removes gnuplot's titles of the plots, which a browser would show under the mouse.
void remove_titles(pugi::xml_node node) {
    while (node.remove_child("title")) {
    }
    node.remove_child("desc");
    for (const pugi::xml_node child : node.children()) remove_titles(child);
}

}  // namespace

std::optional<std::string> inline_svg(const std::string& svg, const std::string& prefix) {
    pugi::xml_document document;
    if (!document.load_buffer(svg.data(), svg.size(), pugi::parse_default, pugi::encoding_utf8))
        return std::nullopt;
    pugi::xml_node root = document.child("svg");
    if (!root || !root.attribute("viewBox")) return std::nullopt;
    root.remove_attribute("width");
    root.remove_attribute("height");
    remove_titles(root);
    own_ids(root, prefix);
    std::ostringstream out;
    root.print(out, "", pugi::format_raw, pugi::encoding_utf8);
    return out.str();
}

}  // namespace a351::corrector::figure
