#pragma once
/// @file
/// Repeats a program's tests once if they failed while the host paused, as tests/system/steady_host.py does for scripts.

#include <atomic>
#include <chrono>
#include <thread>

/// Looks for pauses of the host until it is destroyed: sleeps 10 ms again and again and compares the clock.
class HostWatch {
public:
    HostWatch();

    /// Ends the watch.
    /// @return the longest pause, zero if none was too long.
    [[nodiscard]] std::chrono::duration<double> longest_pause();

private:
    std::atomic<std::chrono::nanoseconds::rep> longest_ns_{
        0};  ///< Longest pause, 0 before the first.
    std::jthread thread_;
};

/// Returns the exit status for tests that ended with `status` after this longest pause, or runs the program again.
///
/// 0 is passed on, and a failure becomes 1.  A failure with a pause starts the program again in the same process, once:
/// most cases only compute, and what fails twice is not excused by a busy machine.
[[nodiscard]] int judge(int status, std::chrono::duration<double> pause, char** arguments);
