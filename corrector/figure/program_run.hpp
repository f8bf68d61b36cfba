#pragma once
/// @file
/// Runs of another program.

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace a351::corrector {

/// The outcome of a run.
struct ProgramRun {
    bool is_found = true;       ///< The program is in PATH.
    bool is_timed_out = false;  ///< It was killed at its time limit.
    int status = 0;             ///< Exit status; 128 + N if signal N ended it.
    std::string errors;         ///< Text that it wrote to standard error.

    [[nodiscard]] bool is_good() const { return is_found && !is_timed_out && status == 0; }
};

/// Runs a program from PATH without a shell and waits for it.
///
/// Standard input and output are /dev/null, the locale is C.UTF-8 and the time zone UTC.  The rest
/// of the environment is inherited.  CAIRO_DEBUG_PDF is set, so that cairo 1.18 (Debian 13) leaves
/// the objects of a PDF file uncompressed and the date of the run can be removed; cairo 1.16
/// (Debian 12) does so anyway.
/// @param arguments  without the program's name.
/// @param directory  working directory; standard error goes through a file `stderr.txt` there.
/// @param limit      time after which the program is killed.
/// @throws std::system_error  the program cannot be started or waited for.
[[nodiscard]] ProgramRun run_program(const std::string& program,
                                     const std::vector<std::string>& arguments,
                                     const std::filesystem::path& directory,
                                     std::chrono::milliseconds limit);

}  // namespace a351::corrector
