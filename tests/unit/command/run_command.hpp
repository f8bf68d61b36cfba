#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "protocol/text/text_file.hpp"
#include "tests/support/temporary_directory.hpp"

/// The program a351-correct as a script sees it.
namespace a351 {

struct Outcome {
    int status = 0;
    std::string output;
    std::string errors;
};

/// @param environment  e.g. "PATH=bin".
inline Outcome run(const test::TemporaryDirectory& folder, const std::string& arguments,
                   const std::string& environment = {}) {
    const std::string command = "cd '" + folder.path().string() + "' && " + environment +
                                " '" A351_CORRECT "' " + arguments + " > stdout.txt 2> stderr.txt";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), text::read_text_file(folder.path() / "stdout.txt"),
            text::read_text_file(folder.path() / "stderr.txt")};
}

}  // namespace a351
