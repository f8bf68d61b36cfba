#include "corrector/figure/inline_svg.hpp"

#include <sstream>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::figure;

TEST_CASE("an inlined picture has unique ids and takes the available width") {
    pugi::xml_document page;
    const pugi::xml_node place = page.append_child("figure");
    REQUIRE(add_svg(
        place,
        "<?xml version=\"1.0\"?>\n<svg width=\"6\" height=\"4\" viewBox=\"0 0 6 4\" "
        "xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n"
        "<title>t</title><desc>by 5.4</desc><defs><circle id='p'/></defs>"
        "<g id=\"q\"><title>plot</title><use xlink:href='#p'/>"
        "<text filter=\"url(#p)\">a &lt; #b</text></g></svg>",
        "map-"));
    std::ostringstream html;
    place.print(html, "", pugi::format_raw);
    CHECK(html.str() ==
          "<figure><svg viewBox=\"0 0 6 4\" xmlns=\"http://www.w3.org/2000/svg\" "
          "xmlns:xlink=\"http://www.w3.org/1999/xlink\"><defs><circle id=\"map-p\"/></defs>"
          "<g id=\"map-q\"><use xlink:href=\"#map-p\"/>"
          "<text filter=\"url(#map-p)\">a &lt; #b</text></g></svg></figure>");
}

TEST_CASE("an incomplete SVG is not inlined") {
    pugi::xml_document page;
    const pugi::xml_node place = page.append_child("figure");
    for (const char* const picture : {"", "<svg viewBox=\"0 0 6 4\"><g>", "<html/>"}) {
        CHECK_FALSE(add_svg(place, picture, "a-"));
        CHECK_FALSE(place.first_child());
    }
}
