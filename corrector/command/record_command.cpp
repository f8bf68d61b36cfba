#include "corrector/command/record_command.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "corrector/command/figures_option.hpp"
#include "corrector/command/option_values.hpp"
#include "corrector/command/output_option.hpp"
#include "corrector/command/progress_bar.hpp"
#include "corrector/fixed_point/archive_record.hpp"
#include "corrector/fixed_point/csv_record.hpp"
#include "corrector/fixed_point/record_result.hpp"
#include "corrector/report/long_record_page.hpp"
#include "corrector/survey/aligned_text.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector {
namespace {

struct RecordCommandOptions {
    std::vector<std::string> files;
    std::string from, to;
    std::string out = "result";
    double cycle_s = RecordAnalysisOptions{}.cycle_s;
    double shift_s = RecordAnalysisOptions{}.shift_s;
    int ensemble = RecordAnalysisOptions{}.ensemble_size;
    std::uint64_t seed = RecordAnalysisOptions{}.seed;
    std::vector<std::string> figures;
};

/// The data root of a folder, or of a day file within its archive; empty for any other file.
std::filesystem::path root_of(const std::filesystem::path& file) {
    if (std::filesystem::is_directory(file)) return std::filesystem::canonical(file);
    // ROOT/archive/YEAR/NET/STA/CHAN.D/FILE
    std::filesystem::path root = std::filesystem::canonical(file);
    constexpr int kLevels = 6;
    for (int level = 0; level < kLevels; ++level) root = root.parent_path();
    return std::filesystem::exists(root / "metadata" / "station.xml") ? root
                                                                      : std::filesystem::path();
}

/// All pieces in order of time, as one record.
LongRecord joined(std::vector<LongRecord> records) {
    LongRecord all = std::move(records.front());
    for (std::size_t k = 1; k < records.size(); ++k) {
        LongRecord& next = records[k];
        all.is_tide_removed = all.is_tide_removed && next.is_tide_removed;
        std::move(next.stretches.begin(), next.stretches.end(), std::back_inserter(all.stretches));
        std::move(next.inputs.begin(), next.inputs.end(), std::back_inserter(all.inputs));
        std::move(next.warnings.begin(), next.warnings.end(), std::back_inserter(all.warnings));
    }
    std::stable_sort(all.stretches.begin(), all.stretches.end(),
                     [](const RecordStretch& a, const RecordStretch& b) {
                         return a.times.front() < b.times.front();
                     });
    for (std::size_t k = 1; k < all.stretches.size(); ++k) {
        if (all.stretches[k].times.front() > all.stretches[k - 1].times.back()) continue;
        throw InputError("at " + to_rfc3339(all.stretches[k].times.front()) +
                         " two parts of the record overlap; allowed: each instant once");
    }
    return all;
}

LongRecord read_record(const RecordCommandOptions& options) {
    RecordWindow window;
    if (!options.from.empty()) window.from = instant_option("--from", options.from);
    if (!options.to.empty()) window.to = instant_option("--to", options.to);
    if (window.from && window.to && *window.from >= *window.to)
        throw InputError("--to = " + options.to + "; allowed: an instant after --from");
    ProgressBar bar(std::cerr, ::isatty(STDERR_FILENO) == 1, "read");
    const Progress progress = [&bar](std::size_t done, std::size_t total) {
        bar.show(done, total);
    };
    std::vector<std::filesystem::path> roots;
    std::vector<LongRecord> records;
    for (const std::string& file : options.files) {
        const std::filesystem::path root = root_of(file);
        if (root.empty()) {
            records.push_back(read_csv_record(file, window, progress));
        } else if (std::find(roots.begin(), roots.end(), root) == roots.end()) {
            roots.push_back(root);
            records.push_back(read_archive_record(root, window, progress));
        }
    }
    return joined(std::move(records));
}

RecordResult analysed(const RecordCommandOptions& options) {
    RecordResult result;
    result.options.cycle_s = number_option("--cycle", options.cycle_s, 200.0, 7200.0);
    result.options.shift_s = number_option("--shift", options.shift_s, 0.0, options.cycle_s);
    constexpr int kMostMembers = 1'000'000;
    number_option("--ensemble", options.ensemble, 1, kMostMembers);
    result.options.ensemble_size = options.ensemble;
    result.options.seed = options.seed;
    result.options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));

    result.record = read_record(options);
    for (const std::string& warning : result.record.warnings)
        std::cerr << "a351-correct: " << warning << '\n';
    SegmentOptions segments;
    segments.shortest =
        std::max(segments.shortest, least_record_length(options.cycle_s, result.record.step_s));
    result.parts = divide_record(result.record, segments);
    if (result.parts.segments.empty()) {
        std::string message = options.files.front() + ": nothing to analyse";
        for (const RefusedPart& part : result.parts.refused)
            message += "; from " + to_rfc3339(part.start) + " " + part.reason;
        throw InputError(
            message + "; allowed: " +
            fixed(static_cast<double>(segments.shortest) * result.record.step_s / 3600.0, 1) +
            " h or more in one piece");
    }
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
    const RecordResult result = analysed(options);
    nlohmann::ordered_json settings;
    settings["command"] = "record";
    settings["from"] = options.from;
    settings["to"] = options.to;
    settings["cycle_s"] = options.cycle_s;
    settings["shift_s"] = options.shift_s;
    settings["ensemble"] = options.ensemble;
    settings["noise_ratio"] = EemdOptions{}.noise_ratio;
    settings["seed"] = options.seed;
    std::vector<NamedText> files = record_files(result, settings);
    Report page = make_long_record_page(result, settings, options.figures);
    std::move(page.files.begin(), page.files.end(), std::back_inserter(files));
    for (const std::string& warning : page.warnings)
        std::cerr << "a351-correct: " << warning << '\n';
    write_together(options.out, files);
    std::cout << record_text(result) << "\nwritten to " << options.out << '\n';
}

}  // namespace

void add_record_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand("record",
                                                "Analyses hours to weeks at one point: how the "
                                                "unit's acceleration follows its temperature.");
    const auto options = std::make_shared<RecordCommandOptions>();
    command
        .add_option("FILE", options->files,
                    "Data root, day file of its archive (which stands for the root), or CSV")
        ->required()
        ->check(CLI::ExistingPath);
    command.add_option("--from", options->from, "First instant, RFC 3339");
    command.add_option("--to", options->to, "Instant behind the last one");
    command.add_option("--out", options->out, "Folder of the result")->capture_default_str();
    command.add_option("--cycle", options->cycle_s, "Cycle of the oven in seconds, 200 to 7200")
        ->capture_default_str();
    command
        .add_option("--shift", options->shift_s,
                    "Seconds by which the acceleration is moved earlier, as published")
        ->capture_default_str();
    command.add_option("--ensemble", options->ensemble, "Noise realisations averaged")
        ->capture_default_str();
    command.add_option("--seed", options->seed, "Of the noise")->capture_default_str();
    add_figures_option(command, options->figures);
    command.callback([options] { analyse(*options); });
}

}  // namespace a351::corrector
