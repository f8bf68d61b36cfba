#include "protocol/events/face.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/text/catalogue.hpp"

namespace a351::events {

const char* const kOnItsSide =
    text::marked("the box is on its side, or was turned over during the set-up");

std::size_t vertical_axis(const std::array<double, 3>& means_g) {
    return static_cast<std::size_t>(
        std::ranges::min_element(means_g, {},
                                 [](double mean) { return std::abs(std::abs(mean) - 1.0); }) -
        means_g.begin());
}

std::optional<int> face_of(StandardGravity mean) {
    if (!(std::abs(mean.value()) >= kLeastVertical.value())) return std::nullopt;
    return mean.value() < 0.0 ? -1 : 1;
}

std::string_view sign_of(int face) { return face < 0 ? "-" : "+"; }

std::optional<int> parse_face(std::string_view sign) {
    if (sign != "+" && sign != "-") return std::nullopt;
    return sign == "-" ? -1 : 1;
}

}  // namespace a351::events
