/// @file
/// Sifting allocates no memory. This is a separate program because it replaces operator new.

#include "tests/support/catch.hpp"

#include "tests/support/counted_allocations.hpp"
#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {

TEST_CASE("a workspace sifts one record after another without allocating memory") {
    EmdWorkspace emd(1000);
    SiftOptions options;
    for (const EndRule ends : {EndRule::line, EndRule::mirror}) {
        options.ends = ends;
        const std::vector<double> signal = mixed_series(1000);
        test::watched_thread = gettid();
        std::copy(signal.begin(), signal.end(), emd.residue().begin());
        int modes = 0;
        while (!emd.next_mode(options).empty()) ++modes;
        test::watched_thread = 0;
        CHECK(modes > 5);
    }
    CHECK(test::allocations == 0);
}

}  // namespace a351::corrector::eemd
