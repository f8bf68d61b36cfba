#include <fmt/core.h>

#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "corrector/command/commands.hpp"
#include "corrector/command/csv_output.hpp"
#include "corrector/command/options.hpp"
#include "corrector/command/sample_column.hpp"
#include "corrector/reading/smoother.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::command {
namespace {

struct SmoothOptions {
    std::string input;
    std::string column;
    double cutoff = 0.0;
    std::string output;
};

reading::SmoothTrend smooth_column(const SmoothOptions& options,
                                   const std::vector<double>& samples) {
    try {
        return reading::smooth(samples, options.cutoff);
    } catch (const std::invalid_argument&) {
        throw InputError(fmt::format(
            "{}: {}: too many samples are missing for --cutoff = {}; allowed: gaps, also at the "
            "ends, that are not much longer than this period",
            options.input, options.column, text::shortest(options.cutoff)));
    }
}

void write_trend(const SmoothOptions& options) {
    number_option("--cutoff", options.cutoff, reading::kShortestCutoff, reading::kLongestCutoff);
    if (!options.output.empty()) require_file_option("--output", options.output, options.input);
    SampleColumn column(options.input, options.column);
    std::vector<double> samples, block;
    while (column.read(block)) samples.insert(samples.end(), block.begin(), block.end());
    const std::size_t present_count = column.count() - column.missing_count();
    if (present_count < reading::kFewestSamples) {
        throw InputError(fmt::format("{}: {}: {} samples; allowed: {} or more", options.input,
                                     options.column, present_count, reading::kFewestSamples));
    }
    const reading::SmoothTrend trend = smooth_column(options, samples);
    const std::vector<double> errors = trend.standard_errors();
    std::string csv = "index,value,standard_error,weight\n";
    for (std::size_t i = 0; i < samples.size(); ++i) {
        csv += fmt::format("{},{},{},{}\n", i, text::shortest(trend.curve[i]),
                           text::shortest(errors[i]), text::shortest(trend.weights[i]));
    }
    write_or_print(options.output, csv);
    std::cerr << fmt::format(
        "a351-correct: smooth: {} samples ({} missing), noise level {}, degrees of freedom {}{}\n",
        column.count(), column.missing_count(), text::shortest(trend.noise_level),
        text::shortest(trend.degrees_of_freedom),
        trend.converged ? "" : "; the weights of the outliers did not converge");
}

}  // namespace

void add_smooth_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "smooth",
        "Finds the trend of a column by Whittaker's smoother, with standard errors for white "
        "noise. "
        "Writes CSV index,value,standard_error,weight. Gaps are bridged, outliers get no weight.");
    const auto options = std::make_shared<SmoothOptions>();
    add_column_options(command, options->input, options->column);
    add_required(command, "--cutoff", "SAMPLES", options->cutoff,
                 "Period at which the smoother passes half of the amplitude, 2-5000 samples");
    add_option(command, "--output", "CSV", options->output,
               "File to write instead of standard output");
    command.callback([options] { write_trend(*options); });
}

}  // namespace a351::corrector::command
