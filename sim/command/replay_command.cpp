#include <array>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>

#include "protocol/core/input_error.hpp"
#include "protocol/events/occupations.hpp"
#include "sim/command/commands.hpp"
#include "sim/command/options.hpp"
#include "sim/line/sensor_port.hpp"
#include "sim/replay/replay_device.hpp"

namespace a351::sim::command {
namespace {

struct ReplayCommand {
    std::vector<std::filesystem::path> files;
    std::string link;
    std::string speed = "1";  ///< A factor, or "max".
    std::string clock;
    std::string axes = "1,2,Z";
    bool is_show = false;
    UnitOptions unit;  ///< Unit of a miniSEED recording, which does not name it.
};

constexpr double kSlowest = 1e-3, kFastest = 1e6;

double factor_of(const std::string& speed) {
    double factor = 0.0;
    const char* const end = speed.data() + speed.size();
    const auto parsed = std::from_chars(speed.data(), end, factor);
    if (parsed.ec != std::errc() || parsed.ptr != end || factor < kSlowest || factor > kFastest)
        throw InputError("--speed " + speed + ": not a speed; allowed: max, or 0.001 ... 1000000");
    return factor;
}

std::array<std::string, 3> axes_of(const std::string& text) {
    if (text.size() != 5 || text[1] != ',' || text[3] != ',') {
        throw InputError("--axes " + text +
                         ": not three letters; allowed: the last letters of the channels of x, y "
                         "and z, such as 1,2,Z");
    }
    return {text.substr(0, 1), text.substr(2, 1), text.substr(4, 1)};
}

replay::RecordingFiles files_of(const ReplayCommand& command) {
    replay::RecordedUnit unit{&profile_of(command.unit.profile), {}, 460800};
    unit.identity.product_id = product_of(command.unit);
    unit.identity.serial_number = command.unit.serial;
    return {command.files, axes_of(command.axes), unit};
}

replay::Timing timing_of(const ReplayCommand& command) {
    if (!command.clock.empty()) return replay::Timing::as_recorded;
    return command.speed == "max" ? replay::Timing::as_fast_as_read
                                  : replay::Timing::from_host_start;
}

void report_restarts(const replay::Report& report) {
    if (report.restarts == 0) return;
    std::cerr << "a351-sim: the host configured the sensor again within a session ("
              << report.restarts << " times); what was due followed, up to "
              << std::chrono::duration<double>(report.longest_delay).count() << " s late\n";
}

void report_damage(const replay::Recording& recording) {
    for (const replay::RecordingDamage& damage : recording.damage()) {
        std::cerr << "a351-sim: " << damage.file.string() << ": " << damage.byte_count
                  << " bytes from offset " << damage.offset
                  << " on were not replayed: " << damage.reason << '\n';
    }
    if (const auto left_out = recording.incomplete_samples(); left_out > 0) {
        std::cerr << "a351-sim: " << left_out
                  << " samples were not replayed, because a channel lacks them\n";
    }
}

/// Prints the first and the last instant, and the stays in the event logs of data roots.
void show(const ReplayCommand& command) {
    const auto recording = replay::open_recording(files_of(command));
    const replay::Extent extent = replay::extent_of(*recording);
    std::cout << "start_utc=" << to_rfc3339(extent.first, 3)
              << " end_utc=" << to_rfc3339(extent.last, 3) << " sessions=" << extent.sessions
              << '\n';
    report_damage(*recording);
    std::vector<events::Occupation> stays;
    for (const auto& root : command.files)
        for (auto& stay : events::occupations_of(events::read_events(root / "events").events))
            stays.push_back(std::move(stay));
    if (!stays.empty()) std::cout << "site,occupation,start_utc,end_utc,key\n";
    for (const events::Occupation& stay : stays)
        for (const auto& set_up : stay.set_ups)
            std::cout << stay.site << ',' << stay.number << ',' << to_rfc3339(set_up.start, 3)
                      << ',' << to_rfc3339(set_up.end, 3) << ',' << stay.key << '\n';
}

void run(const ReplayCommand& command, const std::function<bool()>& should_stop) {
    if (command.is_show) return show(command);
    if (command.link.empty()) throw InputError("--link PATH is required, or --show");
    replay::Device device(replay::open_recording(files_of(command)), timing_of(command),
                          line::steady_now());
    const double factor = command.speed == "max" ? 1.0 : factor_of(command.speed);
    const ClockScale clock = clock_of(command.clock, factor, device.first_due());
    line::Line line({}, 0, clock.utc, [](const truth::Record&) {});
    line::Pty pty(command.link, device.baud());
    line::SensorPort port(pty, device, line);
    std::array<line::Service*, 1> services{&port};
    line::attend(services, clock, [&] { return should_stop() || port.is_finished(); });
    report_restarts(device.report());
    report_damage(device.recording());
}

}  // namespace

void add_replay_command(CLI::App& app, UntilStopped until_stopped) {
    const auto command = std::make_shared<ReplayCommand>();
    CLI::App* replay = app.add_subcommand("replay", "Serves a recording on a pseudo-terminal.");
    replay
        ->add_option("FILE", command->files,
                     "Data root, or journal segments, or miniSEED files, or their directories")
        ->type_name("")
        ->required();
    replay
        ->add_option("--link", command->link,
                     "Symbolic link to make to the sensor's pseudo-terminal")
        ->type_name("PATH");
    replay->add_flag("--show", command->is_show,
                     "Print first and last instant, and the stays of data roots, and exit");
    CLI::Option* clock = add_clock(*replay, command->clock);
    replay
        ->add_option("--speed", command->speed,
                     "Recorded seconds per real second; max: as fast as the host reads")
        ->type_name("X|max")
        ->excludes(clock)
        ->capture_default_str();
    replay
        ->add_option("--axes", command->axes,
                     "Last letters of the channels of x, y and z (miniSEED only)")
        ->type_name("X,Y,Z")
        ->capture_default_str();
    add_unit(*replay, command->unit, " (miniSEED only)");
    replay->callback([command, until_stopped] { run(*command, until_stopped()); });
}

}  // namespace a351::sim::command
