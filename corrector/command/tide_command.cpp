#include <fmt/core.h>

#include <memory>

#include "corrector/command/commands.hpp"
#include "corrector/command/csv_output.hpp"
#include "corrector/command/options.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::command {
namespace {

struct TideOptions {
    double latitude_deg = 0.0;
    double longitude_deg = 0.0;
    double height_m = 0.0;
    std::string from;
    std::string to;
    double step_s = 0.0;
    std::string model = "direct";
    tide::Factors factors;
    std::string system;  ///< Empty: not given, and not named in the table.
    std::string output;
};

void write_series(const TideOptions& options) {
    const tide::Station station{
        Degrees(number_option("--latitude", options.latitude_deg, -90.0, 90.0)),
        Degrees(number_option("--longitude", options.longitude_deg, -180.0, 360.0)),
        Metres(number_option("--height", options.height_m, text::kLeastAltitude_m,
                             text::kGreatestAltitude_m))};
    const UtcTime from = instant_option("--from", options.from);
    const UtcTime to = instant_option("--to", options.to);
    if (to < from) {
        throw InputError(fmt::format("--to = {}: before --from; allowed: {} or later", options.to,
                                     options.from));
    }
    const Nanoseconds step = from_seconds(number_option("--step", options.step_s, 0.001, 1e6));
    const tide::Factors factors = tide_factor_options(options.factors);
    if (!options.output.empty()) require_file_option("--output", options.output);
    tide::Choice choice;
    choice.source = options.model;
    if (!options.system.empty()) tide::set_tide_system(choice, options.system, "--tide-system");
    const tide::Model model = tide::tide_model(options.model);
    constexpr Nanoseconds kSecond = std::chrono::seconds(1);
    const bool is_whole =
        from.time_since_epoch() % kSecond == Nanoseconds(0) && step % kSecond == Nanoseconds(0);

    const bool names_system = !options.system.empty();
    std::string csv = names_system ? "time,tide_mgal,tide_system\n" : "time,tide_mgal\n";
    for (UtcTime time = from; time <= to; time += step) {
        const MilliGal value = tide::earth_tide(model, time, station, factors, choice.system);
        csv += fmt::format("{},{}{}{}\n", to_rfc3339(time, is_whole ? 0 : 9),
                           text::fixed(value.value(), 6), names_system ? "," : "", options.system);
    }
    write_or_print(options.output, csv);
}

}  // namespace

void add_tide_command(CLI::App& program) {
    CLI::App& command = *program.add_subcommand(
        "tide",
        "Writes the tide of the solid Earth as CSV time,tide_mgal: its effect on gravity, positive "
        "where gravity is larger. Subtract it from a reading.");
    const auto options = std::make_shared<TideOptions>();
    add_required(command, "--latitude", "DEG", options->latitude_deg,
                 "Geodetic latitude, degrees north");
    add_required(command, "--longitude", "DEG", options->longitude_deg, "Longitude, degrees east");
    add_required(command, "--height", "M", options->height_m, "Height above the ellipsoid");
    add_required(command, "--from", "UTC", options->from, "First instant (RFC 3339)");
    add_required(command, "--to", "UTC", options->to, "Last instant, included (RFC 3339)");
    add_required(command, "--step", "S", options->step_s, "Time between two rows");
    add_with_default(command, "--model", "NAME", options->model,
                     "Tide model; catalogue is the same as direct")
        ->check(CLI::IsMember({"direct", "catalogue", "longman"}));
    add_tide_factors(command, options->factors);
    add_tide_system(command, options->system);
    add_option(command, "--output", "CSV", options->output,
               "File to write instead of standard output");
    command.callback([options] { write_series(*options); });
}

}  // namespace a351::corrector::command
