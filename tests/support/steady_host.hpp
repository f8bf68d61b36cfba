#pragma once
/// @file
/// Repeats the tests of a program once if they failed while the host paused, as
/// tests/system/steady_host.py does for scripts.

#include <atomic>
#include <chrono>
#include <thread>

/// Detects pauses of the host until it is destroyed: sleeps 10 ms repeatedly and compares the
/// clock.
class HostWatch {
public:
    HostWatch();

    /// Ends the watch.
    /// @return the longest pause; zero if there was none longer than 0.25 s
    [[nodiscard]] std::chrono::duration<double> longest_pause();

private:
    std::atomic<std::chrono::nanoseconds::rep> longest_ns_{
        0};  ///< Longest pause, 0 before the first.
    std::jthread thread_;
};

/// Returns the exit status of tests that ended with `status`, or runs the program again if they
/// failed in a pause.
///
/// Returns 0 for success and 1 for a failure.  A failure with a pause starts the program again in
/// the same process, once.  A second failure counts even with a pause, because most cases only
/// compute and do not depend on time.
[[nodiscard]] int judge(int status, std::chrono::duration<double> pause, char** arguments);
