#include "tests/support/steady_host.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace {

using std::chrono::nanoseconds;

constexpr nanoseconds kSleep = std::chrono::milliseconds(10);
/// Longest delay that is not a pause, as in tests/system/steady_host.py, which gives the reason.
constexpr nanoseconds kLongestDelay = std::chrono::milliseconds(250);
constexpr int kFailed = 1;
constexpr auto kIsSecondRun = "A351_HOST_PAUSED";

}  // namespace

HostWatch::HostWatch()
    : thread_([this](const std::stop_token& is_over) {
          while (!is_over.stop_requested()) {
              // The clock on which the test cases wait too.  changed_clocks_test.cpp changes the
              // other clocks.
              const auto before = std::chrono::steady_clock::now();
              std::this_thread::sleep_for(kSleep);
              const nanoseconds pause = std::chrono::steady_clock::now() - before - kSleep;
              if (pause > kLongestDelay && pause.count() > longest_ns_) longest_ns_ = pause.count();
          }
      }) {}

std::chrono::duration<double> HostWatch::longest_pause() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    return nanoseconds(longest_ns_);
}

int judge(int status, std::chrono::duration<double> pause, char** arguments) {
    if (pause.count() > 0)
        std::fprintf(stderr,
                     "steady_host: the host paused for %.1f s; the run ended with status %d\n",
                     pause.count(), status);
    if (status == 0) return 0;
    if (pause.count() == 0 || std::getenv(kIsSecondRun) != nullptr) return kFailed;
    std::fputs("steady_host: this does not count; the run is repeated once\n", stderr);
    std::fflush(nullptr);
    ::setenv(kIsSecondRun, "1", 1);
    ::execv("/proc/self/exe", arguments);
    std::perror("steady_host: the program cannot be started again");
    return kFailed;
}
