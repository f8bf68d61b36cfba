#include "protocol/events/face.hpp"

#include <limits>

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::events;

TEST_CASE(
    "the face is the side on which the vertical axis points up, and a box on its side has none") {
    CHECK(vertical_axis({0.01, -0.02, -0.998}) == 2);
    CHECK(vertical_axis({-0.999, 0.0, 0.03}) == 0);
    CHECK(face_of(StandardGravity(0.95)) == 1);
    CHECK(face_of(StandardGravity(-0.9)) == -1);
    CHECK_FALSE(face_of(StandardGravity(0.89)));
    CHECK_FALSE(face_of(StandardGravity(-0.02)));
    CHECK_FALSE(face_of(StandardGravity(std::numeric_limits<double>::quiet_NaN())));
    for (const int face : {1, -1}) CHECK(parse_face(sign_of(face)) == face);
    for (const char* const other : {"", "+1", "up", "0"}) CHECK_FALSE(parse_face(other));
}
