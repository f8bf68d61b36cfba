#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <span>
#include <vector>

#include "corrector/command/commands.hpp"
#include "corrector/command/csv_output.hpp"
#include "corrector/command/options.hpp"
#include "corrector/command/sample_column.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/signal/decimator.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/progress_bar.hpp"

namespace a351::corrector::command {
namespace {

constexpr int kMostStages = 9;

struct DecimateOptions {
    std::string input;
    std::string column;
    int factor = 10;
    int stages = 1;
    std::string output;
};

/// Rows of the result, written in pieces.
class DecimatedRows {
public:
    explicit DecimatedRows(CsvOutput& output) : output_(output) {}

    void add(std::span<const double> values) {
        for (const double value : values) {
            const bool is_valid = !std::isnan(value);
            text_ += std::to_string(count_++);
            text_ += is_valid ? ',' + text::shortest(value) + ",1\n" : ",,0\n";
            valid_count_ += is_valid ? 1 : 0;
        }
    }

    void flush() {
        output_.write(text_);
        text_.clear();
    }

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t valid_count() const noexcept { return valid_count_; }

private:
    CsvOutput& output_;
    std::string text_ = "index,value,valid\n";
    std::size_t count_ = 0;
    std::size_t valid_count_ = 0;
};

/// Returns the largest memory of this process; getrusage() would include its parent's.
std::size_t peak_memory_kib() {
    std::ifstream status("/proc/self/status");
    std::string key;
    std::size_t kibibytes = 0;
    while (status >> key) {
        if (key == "VmHWM:") status >> kibibytes;
    }
    return kibibytes;
}

void write_decimated(const DecimateOptions& options) {
    number_option("--factor", options.factor, 2, 1000);
    number_option("--stages", options.stages, 1, kMostStages);
    if (!options.output.empty()) require_file_option("--output", options.output, options.input);
    const signal::DecimationFilter filter = signal::design_decimation(options.factor);
    const double least = signal::least_length(filter, options.stages);
    SampleColumn column(options.input, options.column);
    CsvOutput output(options.output);
    DecimatedRows rows(output);
    signal::Decimator decimator(filter, options.stages);
    text::ProgressBar bar("decimate, MB");

    std::vector<double> samples;
    std::vector<double> decimated;
    while (column.read(samples)) {
        decimated.clear();
        decimator.push(samples, decimated);
        rows.add(decimated);
        // Nothing is written before the record is known to be long enough.
        if (static_cast<double>(column.count()) >= least) rows.flush();
        bar(column.bytes_read() / 1'000'000, column.byte_count() / 1'000'000);
    }
    if (static_cast<double>(column.count()) < least) {
        throw InputError(fmt::format(
            "{}: {}: {} rows are too short; allowed: {} or more for this factor and these stages",
            options.input, options.column, column.count(), text::shortest(least)));
    }
    decimated.clear();
    decimator.finish(decimated);
    rows.add(decimated);
    rows.flush();
    output.finish();
    std::cerr << fmt::format(
        "a351-correct: decimate: {} samples ({} missing) to {} values ({} valid); peak memory {} "
        "KiB\n",
        column.count(), column.missing_count(), rows.count(), rows.valid_count(),
        peak_memory_kib());
}

}  // namespace

void add_decimate_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "decimate",
        "Lowers the rate of a column by an integer factor M per stage, after a low-pass filter of "
        "8 M + 3 taps. Writes CSV index,value,valid. Output row k is centred on input row "
        "k M^stages. Memory does not grow with the input.");
    const auto options = std::make_shared<DecimateOptions>();
    add_column_options(command, options->input, options->column);
    add_required(command, "--factor", "M", options->factor, "Factor of each stage, 2-1000");
    add_with_default(command, "--stages", "K", options->stages, "Number of stages, 1-9");
    add_option(command, "--output", "CSV", options->output,
               "File to write instead of standard output");
    command.callback([options] { write_decimated(*options); });
}

}  // namespace a351::corrector::command
