#include "corrector/command/smooth_command.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "corrector/command/csv_output.hpp"
#include "corrector/command/option_values.hpp"
#include "corrector/command/output_option.hpp"
#include "corrector/command/sample_column.hpp"
#include "corrector/reading/smoother.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector {
namespace {

struct SmoothOptions {
    std::string input;
    std::string column;
    double cutoff = 0.0;
    std::string output;
};

std::vector<double> read_all(SampleColumn& column) {
    std::vector<double> samples;
    std::vector<double> block;
    while (column.read(block)) samples.insert(samples.end(), block.begin(), block.end());
    return samples;
}

SmoothTrend smooth_column(const SmoothOptions& options, const std::vector<double>& samples) {
    try {
        return smooth(samples, options.cutoff);
    } catch (const std::invalid_argument&) {
        throw InputError(
            options.input + ": " + options.column +
            ": too many samples are missing for --cutoff = " + text::shortest(options.cutoff) +
            "; allowed: gaps, also at the ends, that are not much longer than this period");
    }
}

void write_trend(const SmoothOptions& options) {
    number_option("--cutoff", options.cutoff, kShortestCutoff, kLongestCutoff);
    if (!options.output.empty()) require_file_option("--output", options.output);
    SampleColumn column(options.input, options.column);
    const std::vector<double> samples = read_all(column);
    const std::size_t present_count = column.count() - column.missing_count();
    if (present_count < kFewestSamples) {
        throw InputError(options.input + ": " + options.column + ": " +
                         std::to_string(present_count) +
                         " samples; allowed: " + std::to_string(kFewestSamples) + " or more");
    }
    const SmoothTrend trend = smooth_column(options, samples);
    const std::vector<double> errors = trend.standard_errors();
    std::string csv = "index,value,standard_error,weight\n";
    for (std::size_t i = 0; i < samples.size(); ++i) {
        csv += std::to_string(i) + ',' + text::shortest(trend.curve[i]) + ',' +
               text::shortest(errors[i]) + ',' + text::shortest(trend.weights[i]) + '\n';
    }
    write_or_print(options.output, csv);
    std::cerr << "a351-correct: smooth: " << column.count() << " samples ("
              << column.missing_count() << " missing), noise level "
              << text::shortest(trend.noise_level) << ", degrees of freedom "
              << text::shortest(trend.degrees_of_freedom)
              << (trend.converged ? "" : "; the weights of the outliers did not converge") << '\n';
}

}  // namespace

void add_smooth_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "smooth",
        "Finds the trend of a column by Whittaker's smoother, with standard errors for white "
        "noise. "
        "Writes CSV index,value,standard_error,weight. Gaps are bridged, outliers get no weight.");
    const auto options = std::make_shared<SmoothOptions>();
    command
        .add_option("--input", options->input,
                    "Table with a header line; a column time, time_utc or time_s must ascend in "
                    "equal steps")
        ->type_name("CSV")
        ->required();
    command
        .add_option("--column", options->column,
                    "Column to read; an empty cell is a missing sample")
        ->type_name("NAME")
        ->required();
    command
        .add_option("--cutoff", options->cutoff,
                    "Period at which the smoother passes half of the amplitude, 2-5000 samples")
        ->type_name("SAMPLES")
        ->required();
    command.add_option("--output", options->output, "File to write instead of standard output")
        ->type_name("CSV");
    command.callback([options] { write_trend(*options); });
}

}  // namespace a351::corrector
