#include "corrector/figure/inline_svg.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::figure;

TEST_CASE("an inlined picture has unique ids and takes the available width",
          "[report][inline_svg]") {
    const auto html = inline_svg(
        "<?xml version=\"1.0\"?>\n<svg width=\"6\" height=\"4\" viewBox=\"0 0 6 4\" "
        "xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n"
        "<title>t</title><desc>by 5.4</desc><defs><circle id='p'/></defs>"
        "<g id=\"q\"><title>plot</title><use xlink:href='#p'/>"
        "<text filter=\"url(#p)\">a &lt; #b</text></g></svg>",
        "map-");
    CHECK(html.value() ==
          "<svg viewBox=\"0 0 6 4\" xmlns=\"http://www.w3.org/2000/svg\" "
          "xmlns:xlink=\"http://www.w3.org/1999/xlink\"><defs><circle id=\"map-p\"/></defs>"
          "<g id=\"map-q\"><use xlink:href=\"#map-p\"/>"
          "<text filter=\"url(#map-p)\">a &lt; #b</text></g></svg>");
}

TEST_CASE("an incomplete SVG is not inlined", "[report][inline_svg]") {
    CHECK_FALSE(inline_svg("", "a-").has_value());
    CHECK_FALSE(inline_svg("<svg viewBox=\"0 0 6 4\"><g>", "a-").has_value());
    CHECK_FALSE(inline_svg("<html/>", "a-").has_value());
}
