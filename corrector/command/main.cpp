/// @file
/// a351-correct: from records and averages to gravity.

#include <fmt/core.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <exception>
#include <iostream>
#include <string_view>
#include <utility>

#include "corrector/command/commands.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/catalogue.hpp"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadUsage = 2;

/// Options and subcommands that earlier versions had, with what replaced them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kRemoved{
    {{"--curve", "the curve follows from the model"},
     {"history", "survey with several survey files writes history.csv and terms.csv"},
     {"--robust-terms", "every model but paper is searched for bad readings"}}};

/// Returns what replaced the removed words of the command line; empty if there are none.
std::string about_removed(int argc, char** argv) {
    std::string text;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        for (const auto& [removed, instead] : kRemoved)
            if (word.substr(0, word.find('=')) == removed && (i == 1 || word.starts_with("--")))
                text += fmt::format("; {} is unknown: {}", removed, instead);
    }
    return text;
}

/// Keeps pieces of freed memory below 8 MB for the next use.  Pages that go back to the system are
/// cleared one by one when they return.  Larger pieces go back: with those up to 32 MB a record of
/// a week needs 120 instead of 87 MB.
void keep_freed_memory() {
    constexpr int kLarge = 8 << 20;  // bytes
    ::mallopt(M_MMAP_THRESHOLD, kLarge);
    ::mallopt(M_TRIM_THRESHOLD, 2 * kLarge);
}

int report(std::string message, int status) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::cerr << "a351-correct: " << message << '\n';
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace a351;
    using namespace a351::corrector;
    keep_freed_memory();
    text::write_in(text::language_of_environment());
    CLI::App program("Corrects the readings of an M-A351 accelerometer to gravity.",
                     "a351-correct");
    program.set_version_flag("--version", "a351-correct " A351_VERSION);
    program.require_subcommand(1);
    command::add_amend_command(program);
    command::add_calibrate_command(program);
    command::add_decimate_command(program);
    command::add_design_command(program);
    command::add_emd_command(program);
    command::add_export_command(program);
    command::add_import_command(program);
    command::add_record_command(program);
    command::add_retime_command(program);
    command::add_smooth_command(program);
    command::add_survey_command(program);
    command::add_table_command(program);
    command::add_tide_command(program);
    try {
        int status = kDone;
        try {
            program.parse(argc, argv);
        } catch (const CLI::RuntimeError& done_in_part) {
            status = done_in_part.get_exit_code();
        }
        std::cout.flush();
        return std::cout ? status : report("standard output: cannot be written", kFailed);
    } catch (const CLI::Success& help_or_version) {
        return program.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
        return report(error.what() + about_removed(argc, argv) + "; see --help", kBadUsage);
    } catch (const InputError& error) {
        return report(error.what(), kBadUsage);
    } catch (const std::exception& error) {
        return report(error.what(), kFailed);
    }
}
