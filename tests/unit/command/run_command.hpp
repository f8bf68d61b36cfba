#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "protocol/text/csv.hpp"
#include "protocol/text/text_file.hpp"
#include "tests/support/catch.hpp"
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

inline nlohmann::json json_of(const test::TemporaryDirectory& folder,
                              const std::string& result = "result") {
    return nlohmann::json::parse(text::read_text_file(folder.path() / result / "result.json"));
}

/// Returns a table that the program wrote.
inline text::CsvTable table_of(const test::TemporaryDirectory& folder,
                               const std::string& file = "result/occupations.csv") {
    return text::read_csv(folder.path() / file);
}

/// Checks that the program refused its input in one line with these words.
inline void check_refused(const Outcome& outcome, const std::string& words) {
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.errors, StartsWith("a351-correct: ") && ContainsSubstring(words));
    CHECK(std::ranges::count(outcome.errors, '\n') == 1);
}

}  // namespace a351
