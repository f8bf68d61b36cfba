#include "corrector/command/calibrate_command.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "corrector/command/calibrate_records.hpp"
#include "corrector/command/calibration_origin.hpp"
#include "corrector/command/counted_readings.hpp"
#include "corrector/command/option_values.hpp"
#include "corrector/command/output_option.hpp"
#include "corrector/command/progress_bar.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/model/tilt_series.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {
namespace {

struct CalibrateOptions {
    std::vector<std::string> tilt, records;
    std::string out, merge, valid_from, valid_to, power_on;
    double within_mgal = WarmUpGuidance{}.within_mgal;
    bool is_within_given = false;
};

/// Reads a survey file, or makes one for a data root with a sites.csv.
SurveyFile series_file(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) return read_survey_file(path);
    SurveyFile survey;
    survey.name = path.filename().string();
    survey.root = path;
    survey.sites = path / "sites.csv";
    return survey;
}

std::vector<std::string> of_archive(const std::vector<text::InputFile>& inputs,
                                    const std::vector<std::string>& sha256) {
    std::vector<std::string> chosen;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        if (inputs[i].role == "archive") chosen.push_back(sha256[i]);
    return chosen;
}

std::string series_text(const TiltSeries& series, const std::string& name) {
    std::string text =
        name + ": " + std::to_string(series.set_ups) + " set-ups, temperature within " +
        text::fixed(series.temperature_range_degc, 3) + " degC, set-ups scatter by " +
        text::fixed(series.placement_mgal, 2) + " mGal\n";
    for (const std::size_t axis : {0U, 1U}) {
        const auto k = static_cast<Eigen::Index>(axis);
        text += std::string("  ") + (axis == 0 ? "x" : "y") + " tilted from " +
                text::fixed(series.least_tilt_deg.at(axis), 2) + " to " +
                text::fixed(series.greatest_tilt_deg.at(axis), 2) + " deg: bias " +
                text::fixed(series.bias.values(k), 1) + " +- " +
                text::fixed(std::sqrt(series.bias.covariance(k, k)), 1) + " mGal\n";
    }
    return text;
}

/// Adds parts that this run has not measured, with the data they come from.
void take_over(Calibration& calibration, const std::string& file) {
    const Calibration other = read_calibration(file);
    if (other.serial_number != calibration.serial_number)
        throw InputError(file + ": serial_number = " + other.serial_number +
                         ": another unit; allowed: " + calibration.serial_number);
    if (!calibration.axis_bias) calibration.axis_bias = other.axis_bias;
    if (!calibration.thermal) calibration.thermal = other.thermal;
    if (!calibration.warm_up) calibration.warm_up = other.warm_up;
    for (const CalibrationData& data : other.data) list_data(calibration, data);
    calibration.valid_from = std::max(calibration.valid_from, other.valid_from);
    calibration.valid_to = other.valid_to;
}

void calibrate_from_tilt(Calibration& calibration, const std::vector<std::string>& files) {
    std::vector<TiltSeries> all;
    CountedReadings counted;
    for (const std::string& file : files) {
        const SurveyFile survey = series_file(file);
        ProgressBar bar(std::cerr, ::isatty(STDERR_FILENO) == 1, survey.name);
        const OccupationRows read = read_survey(
            survey, [&bar](std::size_t done, std::size_t total) { bar.show(done, total); });
        for (const std::string& warning : read.warnings)
            std::cerr << "a351-correct: " << survey.name << ": " << warning << '\n';
        all.push_back(measure_axis_bias(read, file));
        const std::vector<std::string> sha256 = note_origin(
            calibration, read.serial_number,
            read.rows.front().start.value_or(read.rows.front().time), read.inputs, file);
        counted.add(read.rows, of_archive(read.inputs, sha256), file);
        std::cout << series_text(all.back(), survey.name);
    }
    calibration.axis_bias = combine(all);
}

RecordCalibrationOptions record_options(const CalibrateOptions& options) {
    RecordCalibrationOptions records;
    records.files = options.records;
    number_option("--within", options.within_mgal, 1e-3, 1e3);
    if (options.is_within_given) records.within_mgal = options.within_mgal;
    if (!options.power_on.empty())
        records.power_on = instant_option("--power-on", options.power_on);
    return records;
}

void calibrate(const CalibrateOptions& options) {
    if (options.tilt.empty() && options.records.empty())
        throw InputError("no record and no tilt series; allowed: FILE..., --tilt FILE... or both");
    require_file_option("--out", options.out);
    Calibration calibration;
    calibration.program = "a351-correct " A351_VERSION;
    if (!options.tilt.empty()) calibrate_from_tilt(calibration, options.tilt);
    if (!options.records.empty())
        std::cout << calibrate_from_records(calibration, record_options(options));
    if (!options.merge.empty()) take_over(calibration, options.merge);
    if (!options.valid_from.empty())
        calibration.valid_from = instant_option("--valid-from", options.valid_from);
    if (!options.valid_to.empty())
        calibration.valid_to = instant_option("--valid-to", options.valid_to);
    if (calibration.valid_to && *calibration.valid_to <= calibration.valid_from)
        throw InputError(
            (options.valid_to.empty() ? options.merge + ": valid_to_utc" : "--valid-to") + " = " +
            to_rfc3339(*calibration.valid_to) + ": not after " +
            to_rfc3339(calibration.valid_from) + "; allowed: a later instant, by --valid-to");
    const std::filesystem::path out = std::filesystem::absolute(options.out);
    text::write_together(out.parent_path(), {{out.filename().string(), to_toml(calibration)}});
    std::cout << "unit " << calibration.serial_number << ": written to " << options.out << '\n';
}

}  // namespace

void add_calibrate_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "calibrate",
        "Measures properties of one unit before a survey and writes them to a calibration file.");
    const auto options = std::make_shared<CalibrateOptions>();
    command
        .add_option("FILE", options->records,
                    "Long records at one point, for the response to temperature: data roots, day "
                    "files of their archives, or CSV files")
        ->type_name("")
        ->check(CLI::ExistingPath);
    command
        .add_option("--tilt", options->tilt,
                    "Tilt series at one point, for the biases of the horizontal axes: survey files "
                    "(TOML) or data roots with a sites.csv")
        ->type_name("FILE");
    CLI::Option* within =
        command
            .add_option(
                "--within", options->within_mgal,
                "The unit counts as warmed up when its reading is within this many mGal of the "
                "final value (0.001-1000)")
            ->type_name("MGAL")
            ->capture_default_str();
    command
        .add_option("--power-on", options->power_on,
                    "Instant at which the sensor was switched on (RFC 3339), at most half an "
                    "hour before a record begins")
        ->type_name("UTC");
    command.add_option("--out", options->out, "Calibration to write (TOML)")
        ->type_name("FILE")
        ->required();
    command
        .add_option(
            "--merge", options->merge,
            "Calibration of the same unit; parts that are not measured now are taken from it")
        ->type_name("FILE");
    command
        .add_option("--valid-from", options->valid_from,
                    "Start of the validity (RFC 3339; default: the first reading)")
        ->type_name("UTC");
    command
        .add_option("--valid-to", options->valid_to,
                    "End of the validity (RFC 3339; default: until a newer calibration)")
        ->type_name("UTC");
    command.callback([options, within] {
        options->is_within_given = within->count() > 0;
        calibrate(*options);
    });
}

}  // namespace a351::corrector
