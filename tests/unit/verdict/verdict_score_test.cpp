#include "tests/support/verdict_score.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

using namespace a351::daemon;

namespace a351::sim {
namespace {

using daemon::verdict::State;

TEST_CASE("early, late and false verdicts are distinguished", "[verdict][truth]") {
    std::vector<Allowed> truth(1000, Allowed::no);
    std::fill(truth.begin() + 500, truth.begin() + 900, Allowed::yes);
    std::vector<verdict::State> told(1000, verdict::State::settling);

    SECTION("a minute before the truth is not early") {
        std::fill(told.begin() + 440, told.end(), verdict::State::stable);
        const VerdictScore result = score(told, truth);
        CHECK(result.early_s.empty());
        CHECK(result.delays_s == std::vector<double>{0.0});
        CHECK(result.false_s == 160.0);
        CHECK(result.stable_s == 560.0);
    }
    SECTION("more than a minute before the truth is early") {
        std::fill(told.begin() + 439, told.end(), verdict::State::stable);
        CHECK(score(told, truth).early_s == std::vector<double>{439.0});
    }
    SECTION("a late verdict is a delay") {
        std::fill(told.begin() + 620, told.end(), verdict::State::stable);
        CHECK(score(told, truth).delays_s == std::vector<double>{120.0});
    }
    SECTION("a verdict that never comes is an infinite delay") {
        CHECK(std::isinf(score(told, truth).median_delay_s()));
    }
    SECTION("a verdict that comes after a hand at the box is false, not early") {
        std::fill(told.begin() + 915, told.end(), verdict::State::stable);
        const VerdictScore result = score(told, truth);
        CHECK(result.early_s.empty());
        CHECK(result.false_s == 85.0);
    }
}

}  // namespace
}  // namespace a351::sim
