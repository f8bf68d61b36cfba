#include "corrector/command/tide_command.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "corrector/command/csv_output.hpp"
#include "corrector/command/option_values.hpp"
#include "corrector/command/output_option.hpp"
#include "corrector/tide/earth_tide.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

struct TideOptions {
    double latitude_deg = 0.0;
    double longitude_deg = 0.0;
    double height_m = 0.0;
    std::string from;
    std::string to;
    double step_s = 0.0;
    std::string model = "direct";
    TideFactors factors;
    std::string output;
};

/// Returns the number of decimals of a second that instants on this grid need.
int decimals_for(UtcTime from, Nanoseconds step) {
    const auto second = Nanoseconds(std::chrono::seconds(1));
    const bool is_whole =
        from.time_since_epoch() % second == Nanoseconds(0) && step % second == Nanoseconds(0);
    return is_whole ? 0 : 9;
}

void write_series(const TideOptions& options) {
    const TideStation station{
        Degrees(number_option("--latitude", options.latitude_deg, -90.0, 90.0)),
        Degrees(number_option("--longitude", options.longitude_deg, -180.0, 360.0)),
        Metres(number_option("--height", options.height_m, -500.0, 9000.0))};
    const UtcTime from = instant_option("--from", options.from);
    const UtcTime to = instant_option("--to", options.to);
    if (to < from) {
        throw InputError("--to = " + options.to + ": before --from; allowed: " + options.from +
                         " or later");
    }
    const Nanoseconds step = from_seconds(number_option("--step", options.step_s, 0.001, 1e6));
    const TideFactors factors{
        number_option("--delta2", options.factors.delta2, kLeastFactor, kGreatestFactor),
        number_option("--delta3", options.factors.delta3, kLeastFactor, kGreatestFactor)};
    if (!options.output.empty()) require_file_option("--output", options.output);
    const TideModel model = tide_model(options.model);
    const int decimals = decimals_for(from, step);

    std::string csv = "time,tide_mgal\n";
    for (UtcTime time = from; time <= to; time += step) {
        csv += to_rfc3339(time, decimals) + ',' +
               text::fixed(earth_tide(model, time, station, factors).value(), 6) + '\n';
    }
    write_or_print(options.output, std::move(csv));
}

}  // namespace

void add_tide_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "tide",
        "Writes the tide of the solid Earth as CSV time,tide_mgal: its effect on gravity, positive "
        "where gravity is larger. Subtract it from a reading.");
    const auto options = std::make_shared<TideOptions>();
    command.add_option("--latitude", options->latitude_deg, "Geodetic latitude, degrees north")
        ->type_name("DEG")
        ->required();
    command.add_option("--longitude", options->longitude_deg, "Longitude, degrees east")
        ->type_name("DEG")
        ->required();
    command.add_option("--height", options->height_m, "Height above the ellipsoid")
        ->type_name("M")
        ->required();
    command.add_option("--from", options->from, "First instant (RFC 3339)")
        ->type_name("UTC")
        ->required();
    command.add_option("--to", options->to, "Last instant, included (RFC 3339)")
        ->type_name("UTC")
        ->required();
    command.add_option("--step", options->step_s, "Time between two rows")
        ->type_name("S")
        ->required();
    command.add_option("--model", options->model, "Tide model; catalogue is the same as direct")
        ->type_name("NAME")
        ->check(CLI::IsMember({"direct", "catalogue", "longman"}))
        ->capture_default_str();
    command
        .add_option("--delta2", options->factors.delta2,
                    "Gravimetric factor of degree 2 (1: rigid Earth)")
        ->type_name("FACTOR")
        ->capture_default_str();
    command
        .add_option("--delta3", options->factors.delta3,
                    "Gravimetric factor of degree 3 (1: rigid Earth)")
        ->type_name("FACTOR")
        ->capture_default_str();
    command.add_option("--output", options->output, "File to write instead of standard output")
        ->type_name("CSV");
    command.callback([options] { write_series(*options); });
}

}  // namespace a351::corrector
