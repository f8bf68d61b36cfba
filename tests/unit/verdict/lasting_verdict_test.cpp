#include "daemon/verdict/lasting_verdict.hpp"

#include <vector>
#include "tests/support/catch.hpp"

namespace a351::daemon::verdict {
namespace {

/// Gives one verdict a second, each since it began, and returns the seconds at which one is due.
std::vector<int> due(const std::vector<State>& states) {
    const UtcTime start{std::chrono::hours(400000)};
    LastingVerdict lasting;
    std::vector<int> seconds;
    UtcTime since = start;
    for (std::size_t i = 0; i < states.size(); ++i) {
        const UtcTime now = start + std::chrono::seconds(i);
        if (i > 0 && states[i] != states[i - 1]) since = now;
        if (lasting.is_due({states[i], since, {}}, now)) seconds.push_back(static_cast<int>(i));
    }
    return seconds;
}

}  // namespace

TEST_CASE("a verdict that lasts five seconds is logged once", "[verdict]") {
    std::vector states(20, State::settling);
    states.resize(40, State::stable);
    CHECK(due(states) == std::vector{5, 25});
}

TEST_CASE("verdicts that change each second near a limit are not logged", "[verdict]") {
    std::vector states(20, State::settling);
    for (int i = 0; i < 3600; ++i) states.push_back(i % 2 == 0 ? State::stable : State::settling);
    states.resize(states.size() + 5, State::stable);
    states.resize(states.size() + 20, State::settling);
    CHECK(due(states) == std::vector{5});
}

TEST_CASE("no verdict is logged before the first one", "[verdict]") {
    LastingVerdict lasting;
    CHECK_FALSE(lasting.is_due({}, UtcTime{std::chrono::hours(400000)}));
}

}  // namespace a351::daemon::verdict
