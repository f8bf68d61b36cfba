#include "corrector/command/retime_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "protocol/archive/retime.hpp"

namespace a351::corrector {
namespace {

struct RetimeOptions {
    std::filesystem::path root, out;
};

void run(const RetimeOptions& options) {
    const record::RetimeReport report =
        record::retime(record::posix_files(), options.root, options.out);
    for (const record::JournalDamage& damage : report.damage) {
        std::cerr << "a351-correct: " << damage.file.string() << ": offset " << damage.offset
                  << ": " << damage.byte_count << " bytes are not read: " << damage.reason << '\n';
    }
    std::cout << options.out.string() << ": " << report.records << " records of "
              << report.counters.sessions << " runs from " << report.segments
              << " journal segments; " << report.counters.frames << " frames, "
              << report.counters.gaps << " gaps, " << report.counters.samples_missing
              << " samples missing\n";
}

}  // namespace

void add_retime_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "retime",
        "Writes the archive of a data root anew from its journal, with the times that are known "
        "when all is over: arrivals on both sides of every sample, and the host's clock between "
        "the readings at which it was synchronised.");
    const auto options = std::make_shared<RetimeOptions>();
    command.add_option("root", options->root, "Data root with a journal")->required();
    command.add_option("--out", options->out, "Data root to be made: archive, events, metadata")
        ->required();
    command.callback([options] { run(*options); });
}

}  // namespace a351::corrector
