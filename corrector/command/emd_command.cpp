#include <fmt/core.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "corrector/command/commands.hpp"
#include "corrector/command/csv_output.hpp"
#include "corrector/command/options.hpp"
#include "corrector/command/sample_column.hpp"
#include "corrector/eemd/eemd.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/progress_bar.hpp"

namespace a351::corrector::command {
namespace {

constexpr int kMostModes = 64;  // Above floor(log2 n) of any record.
constexpr int kMostThreads = 256;

struct EmdCommandOptions {
    std::string input, column, output;
    eemd::Options eemd;
    int sifts = eemd::FixedSifts{}.count;
    std::optional<int> s_number;
    std::string finish = "extrema", ends = "line";
};

/// Checks the options of the decomposition, and sets those that have another form.
eemd::Options decomposition(const EmdCommandOptions& options) {
    eemd::Options eemd = options.eemd;
    if (eemd.mode_count) number_option("--modes", *eemd.mode_count, 0, kMostModes);
    number_option("--ensemble", eemd.ensemble_size, 1, kMostMembers);
    number_option("--noise", eemd.noise_ratio, 0.0, 1e6);
    number_option("--sifts", options.sifts, 1, eemd::kMaxSifts);
    eemd.stopping = eemd::FixedSifts{options.sifts};
    if (options.s_number) {
        number_option("--s-number", *options.s_number, 1, eemd::kMostSNumberSifts);
        eemd.stopping = eemd::SNumber{*options.s_number};
    }
    eemd.finish = options.finish == "always" ? eemd::FinishRule::always
                                             : eemd::FinishRule::at_most_two_extrema;
    eemd.ends = options.ends == "mirror" ? eemd::EndRule::mirror : eemd::EndRule::line;
    eemd.reflect_ends = options.ends == "reflect";
    if (eemd.complementary_pairs && eemd.ensemble_size % 2 != 0)
        throw InputError(fmt::format("--ensemble = {}; allowed with --pairs: an even number",
                                     eemd.ensemble_size));
    number_option("--threads", eemd.threads, 1, kMostThreads);
    return eemd;
}

std::string to_csv(const eemd::Result& result) {
    std::string csv;
    for (std::size_t k = 1; k <= result.modes.size(); ++k) csv += fmt::format("imf{},", k);
    csv += "residue\n";
    for (std::size_t i = 0; i < result.residue.values.size(); ++i) {
        for (const eemd::Component& mode : result.modes)
            csv += text::shortest(mode.values[i]) + ',';
        csv += text::shortest(result.residue.values[i]) + '\n';
    }
    return csv;
}

/// Properties of each component, for a choice by period instead of by number.
std::string report_csv(const eemd::Result& result) {
    std::string csv = "component,extrema,mean_period_samples,energy_share,standard_error\n";
    const auto add = [&](const std::string& name, const eemd::Component& component) {
        csv += fmt::format(
            "{},{},{},{},{}\n", name, component.extrema_count,
            component.extrema_count > 0 ? text::shortest(component.mean_period_samples) : "",
            text::shortest(component.energy_share),
            component.standard_error ? text::shortest(*component.standard_error) : "");
    };
    for (std::size_t k = 0; k < result.modes.size(); ++k) {
        add(fmt::format("imf{}", k + 1), result.modes[k]);
    }
    add("residue", result.residue);
    return csv;
}

void write_modes(const EmdCommandOptions& options) {
    eemd::Options eemd_options = decomposition(options);
    require_file_option("--output", options.output, options.input);
    SampleColumn column(options.input, options.column, SampleColumn::Missing::refused);
    std::vector<double> signal, block;
    while (column.read(block)) signal.insert(signal.end(), block.begin(), block.end());
    text::ProgressBar bar(options.column);
    eemd_options.progress = std::ref(bar);
    const eemd::Result result = eemd::eemd(signal, eemd_options);
    write_or_print(options.output, to_csv(result));
    write_or_print("", report_csv(result));
}

}  // namespace

void add_emd_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "emd",
        "Decomposes a column into intrinsic mode functions, imf1 (the fastest) first, and a "
        "residue, by ensemble empirical mode decomposition (EEMD). Prints the extrema, period, "
        "share of energy and standard error of each component.");
    const auto options = std::make_shared<EmdCommandOptions>();
    add_required(command, "--input", "CSV", options->input, "Table with a header line");
    add_required(command, "--column", "NAME", options->column,
                 "Column to read; no cell may be empty");
    add_option(
        command, "--modes", "K", options->eemd.mode_count,
        "Number of modes without the residue, 0-64 (default: floor(log2 n) - 1 for n samples)");
    add_with_default(command, "--ensemble", "N", options->eemd.ensemble_size,
                     "Number of noise realisations that are averaged");
    add_with_default(
        command, "--noise", "RATIO", options->eemd.noise_ratio,
        "Standard deviation of the noise, divided by that of the column; 0 is plain EMD");
    CLI::Option* const sifts =
        add_with_default(command, "--sifts", "S", options->sifts, "Number of sifts per mode");
    add_option(command, "--s-number", "S", options->s_number,
               "Stop when the number of extrema has not changed for S consecutive sifts (at most "
               "50 sifts)")
        ->excludes(sifts);
    add_with_default(
        command, "--finish", "RULE", options->finish,
        "extrema: a remainder with two extrema or fewer is the residue; always: sift every mode")
        ->check(CLI::IsMember({"extrema", "always"}));
    add_with_default(
        command, "--ends", "RULE", options->ends,
        "Support of the envelopes at the ends. line: the end sample or the line through the two "
        "nearest extrema; mirror: reflected extrema; reflect: the record reflected about its ends")
        ->check(CLI::IsMember({"line", "mirror", "reflect"}));
    command.add_flag(
        "--pairs", options->eemd.complementary_pairs,
        "Use every noise realisation twice, once negated, so that none remains in the sum");
    add_with_default(command, "--seed", "N", options->eemd.seed, "Seed of the noise generator");
    add_with_default(command, "--threads", "T", options->eemd.threads,
                     "Number of threads; the result does not depend on it");
    add_required(command, "--output", "CSV", options->output,
                 "Table to write: imf1, imf2, ..., residue");
    command.callback([options] { write_modes(*options); });
}

}  // namespace a351::corrector::command
