#include <fmt/core.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "corrector/archive_series/wrong_profile.hpp"
#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "protocol/archive/retime.hpp"
#include "protocol/station/described_again.hpp"

namespace a351::corrector::command {
namespace {

struct RetimeOptions {
    std::filesystem::path root, out;
    std::string profile;
};

archive::RetimeReport retimed(const RetimeOptions& options) {
    files::FileLayer& files = files::posix_files();
    const wire::DeviceProfile* const profile =
        options.profile.empty() ? nullptr : &wire::profile_option("--profile", options.profile);
    if (profile != nullptr)
        if (const auto remark = archive_series::refuse_wrong_profile(options.root, *profile);
            !remark.empty())
            print_warnings({remark});
    return archive::retime(files, options.root, options.out, profile,
                           [&](const auto&... args) { station::describe_again(files, args...); });
}

void run(const RetimeOptions& options) {
    const archive::RetimeReport report = retimed(options);
    for (const journal::Damage& damage : report.damage) {
        std::cerr << fmt::format("a351-correct: {}: offset {}: {} bytes are skipped: {}\n",
                                 damage.file.string(), damage.offset, damage.byte_count,
                                 damage.reason);
    }
    for (const auto& absent : journal::absent_segments(options.root / "journal")) {
        std::cerr << fmt::format(
            "a351-correct: {}: no segment {}{} between {} and {}: copy the journal again\n",
            (options.root / "journal").string(), absent.first,
            absent.last > absent.first ? fmt::format(" to {}", absent.last) : "",
            absent.before.filename().string(), absent.after.filename().string());
    }
    if (report.unsynchronised_runs > 0)
        std::cerr << fmt::format(
            "a351-correct: in {} of {} runs the host's clock was never synchronised: nothing "
            "corrects their times\n",
            report.unsynchronised_runs, report.counters.sessions);
    std::cout << fmt::format(
        "{}: {} records of {} runs from {} journal segments; {} frames, {} gaps, {} samples "
        "missing\n",
        options.out.string(), report.records, report.counters.sessions, report.segments,
        report.counters.frames, report.counters.gaps, report.counters.samples_missing);
    report_damaged_input(!report.damage.empty());
}

}  // namespace

void add_retime_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "retime",
        "Writes the archive of a data root again from its journal, with better times than were "
        "known during the record: they use arrivals before and after each sample, and all "
        "instants at which the host's clock was synchronised.");
    const auto options = std::make_shared<RetimeOptions>();
    add_required(command, "ROOT", "DIR", options->root, "Data root with a journal");
    add_required(command, "--out", "DIR", options->out,
                 "Data root to write: archive, events, metadata");
    add_option(command, "--profile", "NAME|FILE", options->profile,
               "Profile of the sensor, if the record was made with a wrong one");
    command.callback([options] { run(*options); });
}

}  // namespace a351::corrector::command
