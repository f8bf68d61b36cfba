#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>
#include "tests/support/catch.hpp"

/// Case for tests/system/host_pauses.py, which counts its runs and stops the process.
TEST_CASE("a test case that fails when the host pauses", "[.][host_pauses]") {
    using Clock = std::chrono::steady_clock;
    using std::chrono::milliseconds;
    std::ofstream("runs", std::ios::app) << "run\n";
    for (int i = 0; i < 100; ++i) {
        const auto before = Clock::now();
        std::this_thread::sleep_for(milliseconds(10));
        CHECK(Clock::now() - before < milliseconds(500));
    }
    CHECK(std::getenv("A351_MADE_UP_FAILURE") == nullptr);
}
