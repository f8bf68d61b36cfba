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
                  << ": " << damage.byte_count << " bytes are skipped: " << damage.reason << '\n';
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
        "Writes the archive of a data root again from its journal, with better times than were "
        "known during the record: they use arrivals before and after each sample, and all "
        "instants at which the host's clock was synchronised.");
    const auto options = std::make_shared<RetimeOptions>();
    command.add_option("ROOT", options->root, "Data root with a journal")
        ->type_name("DIR")
        ->required();
    command.add_option("--out", options->out, "Data root to write: archive, events, metadata")
        ->type_name("DIR")
        ->required();
    command.callback([options] { run(*options); });
}

}  // namespace a351::corrector
