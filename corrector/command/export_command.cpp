#include <fmt/core.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "corrector/archive_series/export.hpp"
#include "corrector/archive_series/tilt.hpp"
#include "corrector/command/commands.hpp"
#include "corrector/command/options.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/new_file.hpp"

namespace a351::corrector::command {
namespace {

struct Texts {
    archive_series::ExportOptions options;
    std::string from, to, out;
    double rate_hz = 0.0;
};

void run(Texts texts) {
    archive_series::ExportOptions& options = texts.options;
    options.from = instant_option("--from", texts.from);
    options.to = instant_option("--to", texts.to);
    constexpr double kMostRate_hz = 1000.0;
    if (texts.rate_hz != std::floor(texts.rate_hz) || texts.rate_hz < 1.0 ||
        texts.rate_hz > kMostRate_hz) {
        throw InputError(
            fmt::format("--rate = {}: not allowed; allowed: a whole number from 1 to {}",
                        text::shortest(texts.rate_hz), text::shortest(kMostRate_hz)));
    }
    options.rate_hz = static_cast<int>(texts.rate_hz);
    if (options.from >= options.to)
        throw InputError(
            fmt::format("--to = {}: not after --from; allowed: a later instant", texts.to));
    require_file_option("--out", texts.out);
    text::NewFile file(texts.out);
    const archive_series::ExportReport report =
        archive_series::export_channel(options, [&](std::string_view bytes) { file.write(bytes); });
    file.close();
    file.publish();
    for (const archive::Damage& damage : report.damage)
        std::cerr << "a351-correct: " << archive::to_text(damage) << '\n';
    print_warnings(report.remarks, options.root.string() + ": ");
    std::cout << fmt::format("{}: {} values of {} at {} Hz in {} runs without a gap\n", texts.out,
                             report.values, options.channel, options.rate_hz, report.runs);
    if (report.twice)
        std::cerr << fmt::format(
            "a351-correct: {}: instants from {} to {} occur twice, because the host's clock was "
            "set "
            "back: the values are in the order of recording; correct the times with retime\n",
            options.root.string(), to_rfc3339(report.twice->front(), 3),
            to_rfc3339(report.twice->back(), 3));
    report_damaged_input(!report.damage.empty());
}

}  // namespace

void add_export_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "export",
        "Writes a channel of an archive at exact multiples of a period of UTC, by band-limited "
        "interpolation between the sensor's own sample instants. The result is a product "
        "(location code 10), not the record.");
    const auto texts = std::make_shared<Texts>();
    add_required(command, "ROOT", "DIR", texts->options.root, "Data root");
    add_required(command, "--from", "UTC", texts->from, "First instant (RFC 3339)");
    add_required(command, "--to", "UTC", texts->to, "End of the interval, not included (RFC 3339)");
    add_required(
        command, "--channel", "NAME", texts->options.channel,
        "Channel, for example BNZ; or tilt-x, tilt-y: angle of a horizontal axis above the "
        "horizontal, in urad");
    add_required(command, "--rate", "HZ", texts->rate_hz,
                 "Values per second, a whole number from 1 to 1000");
    add_required(command, "--format", "NAME", texts->options.format, "Format of the file")
        ->check(CLI::IsMember(archive_series::export_formats()));
    const CLI::Option* const unit =
        add_option(command, "--unit", "NAME", texts->options.unit,
                   "Unit of the values in CSV; mg and mgal for acceleration only, urad for a tilt "
                   "only (default: counts; urad for a tilt)")
            ->check(CLI::IsMember({"counts", "mg", "mgal", "urad"}));
    add_required(command, "--out", "FILE", texts->out, "File to write");
    command.callback([texts, unit] {
        if (unit->count() == 0 && archive_series::tilt_axis(texts->options.channel))
            texts->options.unit = "urad";
        run(*texts);
    });
}

}  // namespace a351::corrector::command
