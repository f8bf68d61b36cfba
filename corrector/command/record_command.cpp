#include "corrector/command/record_command.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "corrector/command/figures_option.hpp"
#include "corrector/command/option_values.hpp"
#include "corrector/command/output_option.hpp"
#include "corrector/command/progress_bar.hpp"
#include "corrector/command/record_apply.hpp"
#include "corrector/command/record_input.hpp"
#include "corrector/long_record/joined_record.hpp"
#include "corrector/long_record/record_result.hpp"
#include "corrector/report/long_record_page.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {
namespace {

struct RecordCommandOptions {
    std::vector<std::string> files;
    std::string from, to, apply;
    std::string out = "result";
    double cycle_s = RecordAnalysisOptions{}.cycle_s;
    double shift_s = RecordAnalysisOptions{}.shift_s;
    int ensemble = RecordAnalysisOptions{}.ensemble_size;
    std::uint64_t seed = RecordAnalysisOptions{}.seed;
    std::vector<std::string> figures;
};

LongRecord read_record(const RecordCommandOptions& options) {
    RecordWindow window;
    if (!options.from.empty()) window.from = instant_option("--from", options.from);
    if (!options.to.empty()) window.to = instant_option("--to", options.to);
    if (window.from && window.to && *window.from >= *window.to)
        throw InputError("--to = " + options.to + "; allowed: an instant after --from");
    return joined_record(read_records(options.files, window));
}

RecordResult analysed(const RecordCommandOptions& options) {
    RecordResult result;
    result.options.cycle_s = number_option("--cycle", options.cycle_s, 200.0, 7200.0);
    result.options.shift_s = number_option("--shift", options.shift_s, 0.0, options.cycle_s);
    number_option("--ensemble", options.ensemble, 1, kMostMembers);
    result.options.ensemble_size = options.ensemble;
    result.options.seed = options.seed;
    result.options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));

    result.record = read_record(options);
    SegmentOptions segments;
    segments.shortest =
        std::max(segments.shortest, least_record_length(options.cycle_s, result.record.step_s));
    result.parts = divide_or_refuse(result.record, segments, options.files.front());
    const auto longest = std::max_element(
        result.parts.segments.begin(), result.parts.segments.end(),
        [](const RecordSegment& a, const RecordSegment& b) { return a.size() < b.size(); });
    result.analysed = static_cast<std::size_t>(longest - result.parts.segments.begin());
    ProgressBar bar(std::cerr, ::isatty(STDERR_FILENO) == 1, "decompose");
    result.options.progress = [&bar](std::size_t done, std::size_t total) {
        bar.show(done, total);
    };
    result.analysis = analyse_record(result.segment(), result.record.step_s, result.options);
    result.options.progress = nullptr;
    return result;
}

void analyse(const RecordCommandOptions& options) {
    require_folder_option("--out", options.out);
    RecordResult result = analysed(options);
    if (!options.apply.empty()) apply_to(result, options.apply);
    nlohmann::ordered_json settings;
    settings["command"] = "record";
    settings["from"] = options.from;
    settings["to"] = options.to;
    settings["cycle_s"] = options.cycle_s;
    settings["shift_s"] = options.shift_s;
    settings["ensemble"] = options.ensemble;
    settings["noise_ratio"] = EemdOptions{}.noise_ratio;
    settings["seed"] = options.seed;
    settings["apply"] = options.apply;
    std::vector<text::NamedText> files = record_files(result, settings);
    Report page = make_long_record_page(result, settings, options.figures);
    std::move(page.files.begin(), page.files.end(), std::back_inserter(files));
    for (const std::string& warning : page.warnings)
        std::cerr << "a351-correct: " << warning << '\n';
    text::write_together(options.out, files);
    std::cout << record_text(result) << "\nwritten to " << options.out << '\n';
}

}  // namespace

void add_record_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand("record",
                                                "Analyses hours to weeks at one point: how the "
                                                "acceleration follows the temperature.");
    const auto options = std::make_shared<RecordCommandOptions>();
    command
        .add_option("FILE", options->files,
                    "Data roots, day files of their archives (each means its whole root), or CSV "
                    "files")
        ->type_name("")
        ->required()
        ->check(CLI::ExistingPath);
    command
        .add_option("--from", options->from,
                    "First instant (RFC 3339; default: the start of the record)")
        ->type_name("UTC");
    command
        .add_option("--to", options->to,
                    "End of the interval, not included (RFC 3339; default: the end of the record)")
        ->type_name("UTC");
    command
        .add_option("--apply", options->apply,
                    "Correct the record with this calibration of the unit, in two ways")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    command.add_option("--out", options->out, "Folder of the result")
        ->type_name("DIR")
        ->capture_default_str();
    command.add_option("--cycle", options->cycle_s, "Cycle of the oven, 200-7200 s")
        ->type_name("S")
        ->capture_default_str();
    command
        .add_option("--shift", options->shift_s,
                    "Time by which the acceleration is moved earlier, as published")
        ->type_name("S")
        ->capture_default_str();
    command
        .add_option("--ensemble", options->ensemble,
                    "Number of noise realisations that are averaged")
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--seed", options->seed, "Seed of the noise generator")
        ->type_name("N")
        ->capture_default_str();
    add_figures_option(command, options->figures);
    command.callback([options] { analyse(*options); });
}

}  // namespace a351::corrector
