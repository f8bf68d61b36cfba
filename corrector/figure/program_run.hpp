#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace a351::corrector {

struct ProgramRun {
    bool is_found = true;       ///< The program is in PATH.
    bool is_timed_out = false;  ///< It was killed at its time limit.
    int status = 0;             ///< As exit() had it; 128 + N when signal N ended it.
    std::string errors;         ///< What it wrote to standard error.

    [[nodiscard]] bool is_good() const { return is_found && !is_timed_out && status == 0; }
};

/// Runs a program of PATH without a shell and waits for it.  Standard input and output are
/// /dev/null, the locale is C.UTF-8, the time zone UTC, the rest of the environment ours.
/// CAIRO_DEBUG_PDF is set: cairo 1.18 (Debian 13) then leaves the objects of a PDF file uncompressed,
/// the date of the run among them, so that it can be removed; cairo 1.16 (Debian 12) does so anyway.
/// @param arguments  without the program's own name.
/// @param directory  in which it runs; its standard error passes through a file `stderr.txt` there.
/// @throws std::system_error  the machine refuses.
[[nodiscard]] ProgramRun run_program(const std::string& program,
                                     const std::vector<std::string>& arguments,
                                     const std::filesystem::path& directory,
                                     std::chrono::milliseconds limit);

}  // namespace a351::corrector
