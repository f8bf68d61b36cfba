#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include "tests/support/temporary_directory.hpp"

namespace a351 {

/// Another PATH in the environment during the lifetime of the object.
class PathVariable {
public:
    explicit PathVariable(const std::filesystem::path& value) : before_(::getenv("PATH")) {
        ::setenv("PATH", value.c_str(), 1);
    }
    PathVariable(const PathVariable&) = delete;
    PathVariable& operator=(const PathVariable&) = delete;
    ~PathVariable() { ::setenv("PATH", before_.c_str(), 1); }

private:
    std::string before_;
};

/// Writes a shell script as the program `gnuplot` of this folder.
inline void write_gnuplot(const test::TemporaryDirectory& folder, const std::string& script) {
    const auto file = folder.write("gnuplot", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

}  // namespace a351
