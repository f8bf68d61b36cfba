#include "sim/replay_command.hpp"

#include <array>
#include <charconv>
#include <iostream>

#include "protocol/core/input_error.hpp"
#include "sim/line/sensor_port.hpp"
#include "sim/replay/open_recording.hpp"
#include "sim/replay/replay_device.hpp"

namespace a351::sim {
namespace {

constexpr double kSlowest = 1e-3, kFastest = 1e6;

double factor_of(const std::string& speed) {
    double factor = 0.0;
    const char* const end = speed.data() + speed.size();
    const auto parsed = std::from_chars(speed.data(), end, factor);
    if (parsed.ec != std::errc() || parsed.ptr != end || factor < kSlowest || factor > kFastest) {
        throw InputError("--speed " + speed + ": no speed; allowed: max, or 0.001 ... 1000000");
    }
    return factor;
}

std::array<std::string, 3> axes_of(const std::string& text) {
    if (text.size() != 5 || text[1] != ',' || text[3] != ',') {
        throw InputError("--axes " + text +
                         ": not three letters; allowed: the last letters of the channels of x, y "
                         "and z, as in 1,2,Z");
    }
    return {text.substr(0, 1), text.substr(2, 1), text.substr(4, 1)};
}

RecordingFiles files_of(const ReplayCommand& command) {
    const wire::DeviceProfile* const profile = wire::find_profile(command.profile);
    RecordedUnit unit{profile, {}, 460800};
    unit.identity.product_id = command.product.empty() ? product_id_of(*profile) : command.product;
    unit.identity.serial_number = command.serial;
    return {command.files, axes_of(command.axes), unit};
}

ClockScale clock_of(const ReplayCommand& command, UtcTime first_due) {
    const UtcTime now = host_now();
    if (command.clock.empty()) {
        return {command.speed == "max" ? 1.0 : factor_of(command.speed), first_due, now};
    }
    const auto clock = parse_clock_scale(command.clock, now);
    if (!clock) {
        throw InputError("--clock " + command.clock +
                         ": not a clock; allowed: scaled:FACTOR@UTC[,HOST]");
    }
    return *clock;
}

ReplayTiming timing_of(const ReplayCommand& command) {
    if (!command.clock.empty()) return ReplayTiming::as_recorded;
    return command.speed == "max" ? ReplayTiming::as_fast_as_read : ReplayTiming::from_host_start;
}

CLI::Validator eight_characters() {
    return CLI::Validator(
        [](const std::string& value) {
            return value.size() == 8 ? std::string() : "not 8 characters";
        },
        "8 characters");
}

}  // namespace

CLI::App* add_replay(CLI::App& app, ReplayCommand& command) {
    CLI::App* replay = app.add_subcommand("replay", "Serve a recording on a pseudo-terminal");
    replay->add_option("FILE", command.files, "Journal segments, or miniSEED files of a data root")
        ->required();
    replay->add_option("--link", command.link, "Symbolic link that names the terminal")->required();
    CLI::Option* clock =
        replay->add_option("--clock", command.clock, "Simulated time, scaled:FACTOR@UTC[,HOST]");
    replay->add_option("--speed", command.speed, "Recorded seconds per second, or max")
        ->excludes(clock)
        ->capture_default_str();
    replay->add_option("--axes", command.axes, "miniSEED: last letters of the channels of x, y, z")
        ->capture_default_str();
    replay->add_option("--profile", command.profile, "miniSEED: kind of device")
        ->check(CLI::IsMember({"A351", "A352AD10"}))
        ->capture_default_str();
    replay->add_option("--product", command.product, "miniSEED: product identifier")
        ->check(eight_characters());
    replay->add_option("--serial", command.serial, "miniSEED: serial number")
        ->check(eight_characters())
        ->capture_default_str();
    return replay;
}

void run_replay(const ReplayCommand& command, const std::function<bool()>& should_stop) {
    ReplayDevice device(open_recording(files_of(command)), timing_of(command), steady_now());
    const ClockScale clock = clock_of(command, device.first_due());
    Line line({}, 0, clock.utc, [](const TruthRecord&) {});
    Pty pty(command.link, device.baud());
    SensorPort port(pty, device, line);
    std::array<Service*, 1> services{&port};
    attend(services, clock, [&] { return should_stop() || port.is_finished(); });
    for (const RecordingDamage& damage : device.recording().damage()) {
        std::cerr << "a351-sim: " << damage.file.string() << ": " << damage.byte_count
                  << " bytes from offset " << damage.offset << " on not replayed: " << damage.reason
                  << '\n';
    }
    if (const auto left_out = device.recording().incomplete_samples(); left_out > 0) {
        std::cerr << "a351-sim: " << left_out << " samples not replayed: a channel lacks them\n";
    }
}

}  // namespace a351::sim
