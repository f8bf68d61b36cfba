#include "protocol/core/invariant.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <string>
#include "tests/support/catch.hpp"

using namespace a351;

TEST_CASE("a law that holds does nothing, a broken one says it in one line and aborts") {
    require_invariant(true, "one is one");
    int pipe[2];
    REQUIRE(::pipe(pipe) == 0);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        std::signal(SIGABRT, SIG_DFL);
        ::dup2(pipe[1], STDERR_FILENO);
        require_invariant(false, "one is two");
        ::_exit(0);
    }
    ::close(pipe[1]);
    std::string line;
    std::array<char, 256> bytes{};
    for (ssize_t got = 1; (got = ::read(pipe[0], bytes.data(), bytes.size())) > 0;)
        line.append(bytes.data(), static_cast<std::size_t>(got));
    ::close(pipe[0]);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGABRT);
    CHECK(std::ranges::count(line, '\n') == 1);
    // Release builds leave out the directory of the build.
    CHECK_THAT(line, ContainsSubstring("not true that one is two (") &&
                         ContainsSubstring("tests/unit/core/invariant_test.cpp:"));
}
