#include "corrector/command/export_command.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "corrector/command/option_values.hpp"
#include "corrector/command/output_option.hpp"
#include "corrector/export/export.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/new_file.hpp"

namespace a351::corrector {
namespace {

struct Texts {
    ExportOptions options;
    std::string from, to, format, out;
};

void run(Texts texts) {
    ExportOptions& options = texts.options;
    options.from = instant_option("--from", texts.from);
    options.to = instant_option("--to", texts.to);
    options.format = texts.format == "csv" ? ExportFormat::csv : ExportFormat::mseed;
    if (options.from >= options.to)
        throw InputError("--to = " + texts.to + ": not after --from; allowed: a later instant");
    require_file_option("--out", texts.out);
    text::NewFile file(texts.out);
    const ExportReport report =
        export_channel(options, [&](std::string_view bytes) { file.write(bytes); });
    file.close();
    file.publish();
    for (const record::ArchiveDamage& damage : report.damage)
        std::cerr << "a351-correct: " << to_text(damage) << '\n';
    std::cout << texts.out << ": " << report.values << " values of " << options.channel << " at "
              << options.rate_hz << " Hz in " << report.runs << " runs without a gap\n";
}

}  // namespace

void add_export_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "export",
        "Writes a channel of an archive at exact multiples of a period of UTC, by band-limited "
        "interpolation between the sensor's own sample instants. The result is a product "
        "(location code 10), not the record.");
    const auto texts = std::make_shared<Texts>();
    command.add_option("ROOT", texts->options.root, "Data root")->type_name("DIR")->required();
    command.add_option("--from", texts->from, "First instant (RFC 3339)")
        ->type_name("UTC")
        ->required();
    command.add_option("--to", texts->to, "End of the interval, not included (RFC 3339)")
        ->type_name("UTC")
        ->required();
    command.add_option("--channel", texts->options.channel, "Channel, for example BNZ")
        ->type_name("NAME")
        ->required();
    command.add_option("--rate", texts->options.rate_hz, "Values per second, an integer")
        ->type_name("HZ")
        ->required()
        ->check(CLI::Range(1, 1000));
    command.add_option("--format", texts->format, "Format of the file")
        ->type_name("NAME")
        ->required()
        ->check(CLI::IsMember({"csv", "mseed"}));
    command.add_option("--out", texts->out, "File to write")->type_name("FILE")->required();
    command.callback([texts] { run(*texts); });
}

}  // namespace a351::corrector
