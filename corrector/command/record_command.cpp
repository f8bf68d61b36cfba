#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "corrector/archive_series/tilt.hpp"
#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "corrector/command/record_input.hpp"
#include "corrector/long_record/joined_record.hpp"
#include "corrector/long_record/record_result.hpp"
#include "corrector/report/report.hpp"
#include "corrector/tide/permanent_tide.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/or_null.hpp"
#include "protocol/text/progress_bar.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::command {
namespace {

struct RecordCommandOptions {
    std::vector<std::string> files;
    std::string from, to, apply;
    std::string out = "result", tide_system = "tide-free", quantity = "norm";
    long_record::RecordAnalysisOptions analysis;
    figure::FigureOptions figures;
};

long_record::LongRecord read_record(const RecordCommandOptions& options) {
    long_record::RecordWindow window;
    if (!options.from.empty()) window.from = instant_option("--from", options.from);
    if (!options.to.empty()) window.to = instant_option("--to", options.to);
    if (window.from && window.to && *window.from >= *window.to)
        throw InputError(fmt::format("--to = {}; allowed: an instant after --from", options.to));
    return long_record::joined_record(
        read_records(options.files, window, *tide::system_named(options.tide_system)));
}

/// Options that only concern the analysis of the norm.
constexpr std::array kOfNorm{"--tide-system", "--apply",    "--cycle", "--shift",
                             "--mode",        "--ensemble", "--seed"};

/// Reads the tilt of an axis and fits the effect of the temperature.
long_record::RecordResult tilted(const RecordCommandOptions& options, std::size_t axis) {
    long_record::RecordResult result;
    result.record = long_record::tilt_record(read_record(options), axis);
    result.parts = divide_or_refuse(result.record, {}, options.files.front());
    result.tilt = long_record::fit_tilt(result.parts, result.record.step_s, axis);
    return result;
}

long_record::RecordResult analysed(const RecordCommandOptions& options) {
    long_record::RecordResult result;
    result.options = options.analysis;
    number_option("--cycle", result.options.cycle_s, 200.0, 7200.0);
    number_option("--shift", result.options.shift_s, 0.0, result.options.cycle_s);
    number_option("--ensemble", result.options.ensemble_size, 1, kMostMembers);
    result.options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));

    result.record = read_record(options);
    long_record::SegmentOptions segments;
    segments.shortest =
        std::max(segments.shortest,
                 long_record::least_record_length(options.analysis.cycle_s, result.record.step_s));
    result.parts = divide_or_refuse(result.record, segments, options.files.front());
    const auto longest =
        std::ranges::max_element(result.parts.segments, {}, &long_record::RecordSegment::size);
    result.analysed = static_cast<std::size_t>(longest - result.parts.segments.begin());
    if (result.options.mode)
        number_option("--mode", *result.options.mode, 1,
                      eemd::default_mode_count(result.segment().size()));
    text::ProgressBar bar("decompose");
    result.options.progress = std::ref(bar);
    result.analysis =
        long_record::analyse_record(result.segment(), result.record.step_s, result.options);
    result.options.progress = nullptr;
    return result;
}

/// Returns true if the calibration was measured from a file of the record, metadata aside.
bool is_in_sample(const long_record::LongRecord& record, const unit::Calibration& calibration) {
    return std::ranges::any_of(record.inputs, [&](const text::InputFile& input) {
        return input.role != "metadata" &&
               std::ranges::any_of(calibration.data, [&](const unit::CalibrationData& data) {
                   return data.name == input.name &&
                          data.sha256 == text::sha256_of_file(input.path);
               });
    });
}

/// Applies the thermal part of a calibration to the analysed segment, and notes whether the
/// calibration was measured from this record.
/// @throws InputError  the file is not a calibration, has no thermal part, or is of another unit.
void apply_to(long_record::RecordResult& result, const std::string& file) {
    const unit::Calibration calibration = unit::read_calibration(file);
    const std::string& unit = result.segment().serial_number;
    if (!unit.empty() && unit != calibration.serial_number)
        throw InputError(fmt::format(
            "{0}: serial_number = {1}: the record is of unit {2}; allowed: a calibration of {2}",
            file, calibration.serial_number, unit));
    if (!calibration.thermal)
        throw InputError(file + ": thermal is missing; allowed: a calibration from a long record");
    long_record::AppliedCalibration applied =
        long_record::apply_calibration(*calibration.thermal, result.segment(), result.analysis,
                                       long_record::longest_of_band_s(result.options.cycle_s));
    applied.origin =
        text::message("calibration of unit {} ({}, from {}), {}", calibration.serial_number,
                      calibration.program, to_rfc3339(calibration.valid_from),
                      is_in_sample(result.record, calibration)
                          ? text::message("in sample: it was measured from this record")
                          : text::message("measured from other records"));
    if (unit.empty())
        applied.remarks.push_back(text::message(
            "the record has no serial number: it was not checked that the calibration belongs to "
            "this unit"));
    const UtcTime end = calibration.valid_to.value_or(UtcTime::max());
    if (result.segment().start < calibration.valid_from || result.segment().end > end)
        applied.remarks.push_back(
            text::message("the record is not within the calibration's validity"));
    result.record.inputs.push_back(text::describe_input("calibration", file));
    result.applied = std::move(applied);
}

/// Adds the settings of the analysis of the norm.
void add_norm_settings(nlohmann::ordered_json& settings, const RecordCommandOptions& options,
                       const long_record::RecordResult& result) {
    settings["cycle_s"] = result.options.cycle_s;
    settings["shift_s"] = result.options.shift_s;
    settings["mode"] = text::or_null(result.options.mode);
    settings["ensemble"] = result.options.ensemble_size;
    settings["noise_ratio"] = eemd::Options{}.noise_ratio;
    settings["seed"] = result.options.seed;
    settings["apply"] = options.apply;
    settings["tide_system"] = result.record.is_tide_removed ? options.tide_system : "as given";
}

void analyse(const RecordCommandOptions& options, const CLI::App& command) {
    require_folder_option("--out", options.out);
    const std::optional<std::size_t> axis = archive_series::tilt_axis(options.quantity);
    for (const char* const name : kOfNorm)
        if (axis && command.count(name) > 0)
            throw InputError(
                fmt::format("{}: has no effect on --quantity = {}; allowed: with "
                            "--quantity norm only",
                            name, options.quantity));
    long_record::RecordResult result = axis ? tilted(options, *axis) : analysed(options);
    if (!options.apply.empty()) apply_to(result, options.apply);
    nlohmann::ordered_json settings;
    settings["command"] = "record";
    settings["quantity"] = options.quantity;
    settings["from"] = options.from;
    settings["to"] = options.to;
    if (!axis) add_norm_settings(settings, options, result);
    std::vector<text::NamedText> files = long_record::record_files(result, settings);
    report::Report page = report::make_long_record_page(result, settings, options.figures);
    std::ranges::move(page.files, std::back_inserter(files));
    print_warnings({page.warnings.begin(), page.warnings.end()});
    text::write_together(options.out, files);
    std::cout << long_record::record_text(result) << "\nwritten to " << options.out << '\n';
}

}  // namespace

void add_record_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand("record",
                                                "Analyses hours to weeks at one point: how the "
                                                "acceleration follows the temperature.");
    const auto options = std::make_shared<RecordCommandOptions>();
    add_required(
        command, "FILE", "", options->files,
        "Data roots, day files of their archives (each means its whole root), or CSV files")
        ->check(CLI::ExistingPath);
    add_option(command, "--from", "UTC", options->from,
               "First instant (RFC 3339; default: the start of the record)");
    add_option(command, "--to", "UTC", options->to,
               "End of the interval, not included (RFC 3339; default: the end of the record)");
    add_with_default(command, "--quantity", "NAME", options->quantity,
                     "Quantity to analyse: the norm, or the angle of a horizontal axis above the "
                     "horizontal (urad) and its dependence on the temperature")
        ->check(CLI::IsMember({"norm", "tilt-x", "tilt-y"}));
    add_option(command, "--apply", "FILE", options->apply,
               "Correct the record with this calibration of the unit, in two ways")
        ->check(CLI::ExistingFile);
    add_with_default(command, "--out", "DIR", options->out, "Folder of the result");
    add_with_default(command, "--cycle", "S", options->analysis.cycle_s,
                     "Cycle of the oven, 200-7200 s");
    add_with_default(command, "--shift", "S", options->analysis.shift_s,
                     "Time by which the acceleration is moved earlier, as published");
    add_option(command, "--mode", "N", options->analysis.mode,
               "Number of the modes that are compared, the same in both decompositions; 1 is the "
               "fastest (default: in each the mode whose period is nearest to the cycle)");
    add_with_default(command, "--ensemble", "N", options->analysis.ensemble_size,
                     "Number of noise realisations that are averaged");
    add_with_default(command, "--seed", "N", options->analysis.seed, "Seed of the noise generator");
    add_tide_system(command, options->tide_system);
    add_figure_options(command, options->figures);
    command.callback([options, &command] { analyse(*options, command); });
}

}  // namespace a351::corrector::command
