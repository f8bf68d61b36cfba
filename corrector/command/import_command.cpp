#include <fmt/core.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/gravimeter/contradictions.hpp"
#include "corrector/gravimeter/site_names.hpp"
#include "corrector/gravimeter/survey_tables.hpp"
#include "corrector/tide/permanent_tide.hpp"
#include "corrector/tide/tide_check.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::command {
namespace {

struct ImportOptions {
    std::vector<std::string> files;
    std::string out, average = "median", tide = "keep", tide_system, zone;
    std::size_t last = gravimeter::AverageOptions().last;
};

/// Returns local time minus UTC from +hh:mm, -hh:mm or Z; absent if there is no text.
std::optional<std::chrono::minutes> zone_of(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const std::string noon = "2000-01-01T12:00:00";
    const auto there = parse_rfc3339(noon + text), here = parse_rfc3339(noon + "Z");
    if (!there)
        throw InputError(fmt::format("--zone = {}: not a zone; allowed: +hh:mm, -hh:mm, Z", text));
    return std::chrono::duration_cast<std::chrono::minutes>(*here - *there);
}

gravimeter::TableOptions table_options(const ImportOptions& options) {
    gravimeter::TableOptions table{{options.last, options.average == "mean"},
                                   options.tide == "keep"};
    if (options.tide_system.empty()) return table;
    if (!table.keeps_tide)
        throw InputError(
            fmt::format("--tide-system = {}: the table has no tide; allowed: with --tide keep, or "
                        "in the command table",
                        options.tide_system));
    table.tide_system = tide::system_named(options.tide_system);
    return table;
}

void import_files(const ImportOptions& options) {
    require_folder_option("--out", options.out);
    const gravimeter::TableOptions table = table_options(options);
    std::vector<gravimeter::GravimeterFile> files;
    for (const std::string& file : options.files)
        files.push_back(gravimeter::read_gravimeter_file(file, {zone_of(options.zone)}));
    print_warnings(gravimeter::make_table_names(files));
    const std::vector<gravimeter::Stay> stays = gravimeter::find_stays(files);
    for (const gravimeter::GravimeterFile& file : files)
        print_warnings(gravimeter::contradictions(file, tide::usual_tide),
                       file.path.string() + ": ");
    text::write_together(options.out, gravimeter::survey_tables(files, stays, table));

    bool is_damaged = false;
    for (const gravimeter::GravimeterFile& file : files) {
        for (const gravimeter::RefusedLine& line : file.refused)
            std::cerr << fmt::format("a351-correct: {}:{}: {}\n", file.path.string(), line.line,
                                     line.reason);
        std::cout << fmt::format("{}: {}, {}; {} lines: {} readings, {} comments, {} refused\n",
                                 file.path.string(), file.format, file.layout,
                                 file.readings.size() + file.comment_count + file.refused.size(),
                                 file.readings.size(), file.comment_count, file.refused.size());
        is_damaged = is_damaged || !file.refused.empty();
    }
    std::cout << fmt::format(
        "{} stays, written to {}\n"
        "add gravity_mgal and u_gravity_mgal of the known sites to {}\n",
        stays.size(), options.out, (std::filesystem::path(options.out) / "sites.csv").string());
    report_damaged_input(is_damaged);
}

}  // namespace

void add_import_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "import", "Reads files of gravimeters and writes the tables for the command table.");
    const auto options = std::make_shared<ImportOptions>();
    add_required(command, "FILE", "", options->files,
                 "Files of Scintrex CG-5, Scintrex CG-6 or ZLS Burris, or GCYM tables");
    add_required(command, "--out", "DIR", options->out,
                 "Folder for observations.csv, sites.csv and readings.csv");
    add_with_default(command, "--last", "N", options->last,
                     "Readings at the end of each stay that are used; 0: all")
        ->check(CLI::Range(0, 1'000'000));
    add_with_default(command, "--average", "NAME", options->average,
                     "median or mean of these readings")
        ->check(CLI::IsMember({"median", "mean"}));
    add_with_default(command, "--tide", "RULE", options->tide,
                     "keep: earth_tide_mgal has the tide that the instrument removed; remove: "
                     "without this column, so that the command table computes the tide")
        ->check(CLI::IsMember({"keep", "remove"}));
    add_tide_system(command, options->tide_system);
    add_with_default(
        command, "--zone", "ZONE", options->zone,
        "Zone of the times of GCYM tables, which do not state it: +hh:mm, -hh:mm or Z");
    command.callback([options] { import_files(*options); });
}

}  // namespace a351::corrector::command
