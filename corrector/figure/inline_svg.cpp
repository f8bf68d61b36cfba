#include "corrector/figure/inline_svg.hpp"

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

bool add_svg(pugi::xml_node parent, const std::string& svg, const std::string& prefix) {
    const bool is_parsed =
        parent.append_buffer(svg.data(), svg.size(), pugi::parse_default, pugi::encoding_utf8);
    pugi::xml_node root = parent.last_child();
    if (!is_parsed || root.name() != std::string_view("svg") || !root.attribute("viewBox")) {
        parent.remove_children();
        return false;
    }
    root.remove_attribute("width");
    root.remove_attribute("height");
    remove_titles(root);
    own_ids(root, prefix);
    return true;
}

}  // namespace a351::corrector::figure
