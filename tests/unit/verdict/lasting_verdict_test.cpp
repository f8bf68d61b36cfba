#include "daemon/verdict/lasting_verdict.hpp"

#include <vector>
#include "tests/support/catch.hpp"

namespace a351::daemon::verdict {
namespace {

const UtcTime kFirstSecond{std::chrono::hours(400000)};

UtcTime second(int seconds) { return kFirstSecond + std::chrono::seconds(seconds); }

/// Gives one verdict a second, each since it began, and returns those that are to be logged.
std::vector<Change> logged(LastingVerdict lasting, const std::vector<State>& states) {
    std::vector<Change> changes;
    UtcTime since = kFirstSecond;
    for (std::size_t i = 0; i < states.size(); ++i) {
        const UtcTime time = second(static_cast<int>(i));
        if (i > 0 && states[i] != states[i - 1]) since = time;
        if (const auto change = lasting.take({states[i], since, {}}, time))
            changes.push_back(*change);
    }
    return changes;
}

TEST_CASE("a verdict that lasts five seconds is logged once, with its begin", "[verdict]") {
    std::vector states(20, State::settling);
    states.resize(24, State::disturbed);
    states.resize(40, State::stable);
    CHECK(logged(LastingVerdict(), states) ==
          std::vector<Change>{{State::settling, second(0)}, {State::stable, second(24)}});
}

TEST_CASE("verdicts that change each second near a limit are not logged", "[verdict]") {
    std::vector states(20, State::settling);
    for (int i = 0; i < 3600; ++i) states.push_back(i % 2 == 0 ? State::stable : State::settling);
    states.resize(states.size() + 5, State::stable);
    states.resize(states.size() + 20, State::settling);
    CHECK(logged(LastingVerdict(), states) == std::vector<Change>{{State::settling, second(0)}});
}

TEST_CASE("a verdict that was not shown from its begin is logged from when it was", "[verdict]") {
    CHECK(logged(LastingVerdict(second(12)), std::vector(20, State::stable)) ==
          std::vector<Change>{{State::stable, second(12)}});
}

}  // namespace
}  // namespace a351::daemon::verdict
