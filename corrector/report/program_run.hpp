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
/// /dev/null, the locale is C.UTF-8, the rest of the environment ours.
/// @param arguments  without the program's own name.
/// @param directory  in which it runs; its standard error passes through a file `stderr.txt` there.
/// @throws std::system_error  the machine refuses.
[[nodiscard]] ProgramRun run_program(const std::string& program,
                                     const std::vector<std::string>& arguments,
                                     const std::filesystem::path& directory,
                                     std::chrono::milliseconds limit);

}  // namespace a351::corrector
