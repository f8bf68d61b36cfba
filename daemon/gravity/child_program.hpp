#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace a351::daemon::gravity {

/// Limits of a child program.
struct ChildLimits {
    std::chrono::milliseconds time{300'000};  ///< Real time; an idle child may wait for a core.
    std::size_t cpu_s = 60;                   ///< Processor time, s.
    std::size_t memory_bytes = std::size_t{2} << 30U;  ///< Address space; 0: no limit.
    std::size_t output_bytes = std::size_t{4} << 20U;  ///< Standard output.
};

/// How a child program ended.
struct ChildEnd {
    /// Empty if it ended with status 0, else a code:
    /// - no_corrector: there is no such program.
    /// - failed: it could not be started, or ended with another status.
    /// - killed: a signal ended it.
    /// - too_slow: it reached a time limit.
    /// - too_much_output: it printed more than the limit.
    /// - stopped: `stop` ended it.
    std::string trouble;
    std::string output;   ///< Standard output.
    std::string message;  ///< Cause of the trouble: the last line of standard error, or a sentence.
};

/// Runs a program to its end, so that nothing else on the host notices: it gets the processor and
/// the disk only while nobody else wants them (SCHED_IDLE, I/O class idle), and is the first to be
/// killed when memory is short.
///
/// The program has no descriptor of this process, /dev/null as standard input, and no signal
/// blocked.  It is killed when the calling thread ends, also if this process is killed.
/// @param command  path of the program, and its arguments.
/// @param stop     when it becomes true the program is killed, within 0.1 s.
[[nodiscard]] ChildEnd run_child(std::vector<std::string> command, const ChildLimits& limits,
                                 const std::atomic<bool>& stop);

}  // namespace a351::daemon::gravity
