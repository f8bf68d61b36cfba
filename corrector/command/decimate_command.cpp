#include "corrector/command/decimate_command.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "corrector/command/csv_output.hpp"
#include "corrector/command/option_values.hpp"
#include "corrector/signal/decimation.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector {
namespace {

constexpr int kMostStages = 9;

struct DecimateOptions {
    std::string input;
    std::string column;
    int factor = 10;
    int stages = 1;
    std::string output;
};

/// The column; an empty cell is a missing sample.
std::vector<double> read_samples(const DecimateOptions& options) {
    const text::CsvTable table = text::read_csv(options.input);
    std::vector<double> samples;
    samples.reserve(table.row_count());
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        samples.push_back(table.number_if_given(row, options.column)
                              .value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    return samples;
}

void write_decimated(const DecimateOptions& options) {
    number_option("--factor", options.factor, 2, 1000);
    number_option("--stages", options.stages, 1, kMostStages);
    std::vector<double> samples = read_samples(options);
    const DecimationFilter filter = design_decimation(options.factor);
    for (int stage = 0; stage < options.stages; ++stage) samples = decimate(samples, filter);

    std::string csv = "index,value,valid\n";
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const bool is_valid = !std::isnan(samples[k]);
        csv += std::to_string(k) + ',' + (is_valid ? text::shortest(samples[k]) : "") + ',' +
               (is_valid ? '1' : '0') + '\n';
    }
    write_or_print(options.output, std::move(csv));
}

}  // namespace

void add_decimate_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "decimate",
        "Lowers the rate of a column by a whole factor M per stage, after a low-pass of 8 M + 3 "
        "taps, as CSV index,value,valid.  Output number k is centred on input row k M^stages.");
    const auto options = std::make_shared<DecimateOptions>();
    command.add_option("--input", options->input, "CSV with a header line")->required();
    command.add_option("--column", options->column, "Column to read; empty cells are missing")
        ->required();
    command.add_option("--factor", options->factor, "M, 2 to 1000")->required();
    command.add_option("--stages", options->stages, "How often, 1 to 9")->capture_default_str();
    command.add_option("--output", options->output, "File to write instead of standard output");
    command.callback([options] { write_decimated(*options); });
}

}  // namespace a351::corrector
