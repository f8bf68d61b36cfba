#pragma once
/// @file
/// Runs of another program.
///
///     const ProgramRun run = run_program("gnuplot", {"figure.gp"}, folder, 60s);
///     if (!run.is_good()) report(run.errors);
///
/// A program that is missing, fails or takes too long is a result and not an exception.  Arguments
/// reach the program as they are, because no shell reads them.

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace a351::corrector::figure {

/// The outcome of a run.
///
/// Check is_good() first.  The other members say why it is not: a program that was not found has
/// status 0 and no errors; one that was killed at its limit has is_timed_out and status 137.
struct ProgramRun {
    bool is_found = true;       ///< The program is in PATH.
    bool is_timed_out = false;  ///< It was killed at its time limit.
    int status = 0;             ///< Exit status; 128 + N if signal N ended it.
    std::string errors;         ///< Text that it wrote to standard error.

    /// Returns true if the program ran to its end with status 0.
    [[nodiscard]] bool is_good() const { return is_found && !is_timed_out && status == 0; }
};

/// Runs a program from PATH without a shell and waits for it.
///
/// Standard input and output are /dev/null, the locale is C.UTF-8 and the time zone UTC.  The rest
/// of the environment is inherited.  CAIRO_DEBUG_PDF is set, so that cairo 1.18 (Debian 13) leaves
/// the objects of a PDF file uncompressed and the date of the run can be removed; cairo 1.16
/// (Debian 12) does so anyway.
///
/// Only the program itself is killed at the limit, not the processes that it has started.  On a
/// kernel without pidfd_open() (before 5.3) there is no limit.
/// @param program    name to be found in PATH, or a path.
/// @param arguments  without the program's name.
/// @param directory  working directory; standard error goes through a file `stderr.txt` there.  It
///                   must exist and be writable; two runs at once need two directories.
/// @param limit      time after which the program is killed.
/// @throws std::system_error  the program cannot be started or waited for.
[[nodiscard]] ProgramRun run_program(const std::string& program,
                                     const std::vector<std::string>& arguments,
                                     const std::filesystem::path& directory,
                                     std::chrono::milliseconds limit);

}  // namespace a351::corrector::figure
