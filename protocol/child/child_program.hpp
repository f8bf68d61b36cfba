#pragma once
/// @file
/// Runs of another program, from its start to its end.
///
///     const ChildEnd end = run_child({.words = {"gnuplot", "map.gp"}, .directory = folder});
///     if (end.outcome == Outcome::missing) std::cerr << end.message << '\n';
///
/// No shell is involved: each word reaches the program as it is.  A program that is missing, fails
/// or takes too long is a result; only a failure of the host is an exception.
///
/// The call returns when the program has ended.  Give it a thread of its own where nothing may wait.
/// Several threads may call it at a time.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace a351::child {

/// A program and its surroundings.
struct Command {
    /// Program and arguments.  A name without '/' is looked up in PATH, whose empty entries are
    /// skipped; a path is relative to the directory of this process.
    std::vector<std::string> words;
    std::filesystem::path directory = {};     ///< Working directory; empty: that of this process.
    std::vector<std::string> variables = {};  ///< NAME=VALUE; other variables are inherited.
    /// The program gets processor and disk only while nobody else wants them (SCHED_IDLE, I/O class
    /// idle), and is the first to be killed when memory is short.
    bool is_background = false;
};

/// Limits of a run.  0: no limit of processor time or of memory.
struct ChildLimits {
    std::chrono::milliseconds time{300'000};  ///< Real time; an idle child may wait for a core.
    std::size_t cpu_s = 0;                    ///< Processor time, s.
    std::size_t memory_bytes = 0;             ///< Address space.
    std::size_t output_bytes = std::size_t{4} << 20U;  ///< Standard output.
};

/// How a run ended.
enum class Outcome {
    good,             ///< It ended with status 0.
    failed,           ///< It ended with another status, or the host refuses to start it (127).
    killed,           ///< A signal that is not from here ended it.
    missing,          ///< There is no such program.
    too_slow,         ///< It reached a limit of time.
    too_much_output,  ///< It printed more than the limit.
    stopped,          ///< `stop` ended it.
};

/// The end of a run.
struct ChildEnd {
    Outcome outcome = Outcome::good;
    int status = 0;        ///< `failed`: its exit status.  `killed`: the number of the signal.
    std::string output{};  ///< Standard output, until the limit was reached.
    /// Cause, if the outcome is not good: the last line of standard error, or a sentence.  Empty if
    /// it was stopped.
    std::string message{};
};

/// Runs a program to its end.
///
/// The program has no descriptor of this process but three: /dev/null as standard input, and two
/// pipes.  It has no blocked signal and no handler, and writes no core file.  It is the leader of a
/// process group, so that Ctrl-C in a terminal does not reach it.  At a limit the whole group is
/// killed; this takes at most 0.1 s.  The program itself is killed when the calling thread ends, also
/// if this process is killed.  It leaves no zombie.
///
/// A process that the program started and left behind is not waited for, although it still has the
/// pipes.
/// @param command  with at least one word.
/// @param stop     when it becomes true the program is killed, within 0.1 s.
/// @throws std::system_error  the host refuses a pipe, a process or the working directory, or this
///                            process ignores SIGCHLD, so that no status is left to read.
[[nodiscard]] ChildEnd run_child(const Command& command, const ChildLimits& limits = {},
                                 const std::atomic<bool>* stop = nullptr);

}  // namespace a351::child
