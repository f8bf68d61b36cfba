#include <Eigen/Core>
#include "corrector/whole_day/least_cost.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::whole_day;

TEST_CASE("Eigen sums in the same order on every processor") {
#ifdef EIGEN_VECTORIZE
    FAIL("Eigen uses the vector instructions of this processor");
#endif
    CHECK(Eigen::l1CacheSize() == 32768);
    CHECK(Eigen::l2CacheSize() == 262144);
    CHECK(Eigen::l3CacheSize() == 2097152);
}

TEST_CASE("the points and costs of a search do not depend on the last bits of its values") {
    for (const double value : {0.3, -1.7, 11.25, 1e-9}) {
        CHECK(search_point(value) == search_point(value * (1.0 + 1e-13)));
        CHECK(search_point(value) == Approx(value).margin(3.1e-5));
        CHECK(search_cost(100.0 * value) == search_cost(100.0 * value * (1.0 + 1e-13)));
        CHECK(search_cost(100.0 * value) == Approx(100.0 * value).margin(1e-8));
    }
}
