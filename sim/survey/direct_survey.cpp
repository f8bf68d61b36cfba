#include "sim/survey/direct_survey.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <variant>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/archiver.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/journal/journal_writer.hpp"
#include "protocol/oven/registers.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/wire/commands.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/line/transport.hpp"
#include "sim/noise/random.hpp"
#include "sim/oven/oven_controller.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/set_up_truth.hpp"
#include "sim/signal/signal_source.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim::survey {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr std::uint8_t kRateCode = 6, kFilterCode = 6;  // 50 Hz, k512_fc9
constexpr int kBaud = 460800;

/// Uptime of the simulated host at the start of the record: it was booted an hour before.
constexpr Nanoseconds kHostUptime = 1h;

/// Clock error of the simulated host, us: typical of NTP over a good network.
constexpr std::int64_t kHostClockErrorUs = 100;

RawTime raw_at(const scenario::Scenario& scenario, UtcTime utc) {
    return RawTime(kHostUptime + (utc - scenario.start()));
}

timing::ClockReading clock_at(const scenario::Scenario& scenario, UtcTime utc) {
    timing::ClockReading reading;
    reading.raw = raw_at(scenario, utc);
    reading.boottime = reading.raw.time_since_epoch();
    reading.realtime = utc;
    reading.is_synchronised = true;
    reading.max_error_us = reading.estimated_error_us = kHostClockErrorUs;
    return reading;
}

/// Returns the filter of a simulated day.
/// @throws InputError  the profile lacks it.
const wire::FilterSpec& filter_of(const wire::DeviceProfile& profile) {
    if (const auto* const filter = profile.filter_coded(kFilterCode)) return *filter;
    throw InputError(fmt::format("profile {} has no filter with code {}, which a simulated day has",
                                 profile.name, kFilterCode));
}

journal::Header journal_header(const scenario::Scenario& scenario,
                               const wire::DeviceProfile& profile,
                               const device::MachineIdentity& identity, std::uint64_t seed) {
    journal::Header header;
    // Different days with the same seed get different sessions and different hosts.
    noise::RandomStream session(seed, fmt::format("session of {} at {} by {}", scenario.name,
                                                  to_rfc3339(scenario.start(), 3), profile.name));
    for (std::uint8_t& byte : header.session.bytes)
        byte = static_cast<std::uint8_t>(session.bits() >> 56U);
    header.boot_id = fmt::format("00000000-0000-4000-8000-{:012x}", session.bits() >> 16U);
    header.program_version = A351_VERSION;
    header.profile = profile.name;
    header.product_id = identity.product_id;
    header.serial_number = identity.serial_number;
    header.firmware = identity.firmware;
    header.output_rate_hz = signal::Source::kRateHz;
    header.filter = filter_of(profile).name;
    header.burst_ctrl = wire::BurstLayout::recommended().burst_ctrl();
    header.baud = kBaud;
    if (scenario.clock.declared_rate_hz > 0.0)
        header.declared_rate_hz = scenario.clock.declared_rate_hz;
    header.record_age = std::chrono::seconds(scenario.clock.record_age_s);
    header.clock = clock_at(scenario, scenario.start());
    return header;
}

/// Configures the device as the daemon does: 50 Hz, k512_fc9, automatic frames with every field.
void start_logging(device::RegisterMachine& machine, Nanoseconds now) {
    std::vector<std::byte> answers;
    const auto config = *wire::ConfigMode::from_mode_ctrl(wire::kModeStatConfig);
    const auto send = [&](const wire::CommandSequence& commands) {
        for (const wire::Command& command : commands) machine.receive(command, now, answers);
    };
    send(config.write(wire::kSmplCtrl, kRateCode << 8U, wire::kHighByte));
    send(config.write(wire::kFilterCtrl, kFilterCode, wire::kFilterSelect));
    send(config.write(wire::kUartCtrl, wire::kUartAuto, wire::kLowByte));
    send(config.write(wire::kBurstCtrl, wire::BurstLayout::recommended().burst_ctrl(),
                      wire::kBothBytes));
    send(wire::ConfigMode(config).start_sampling().second);
}

void write_station_xml(const scenario::Scenario& scenario, const wire::DeviceProfile& profile,
                       const journal::Header& header, const fs::path& root) {
    const text::Site& base = scenario.sites.front();
    station::Description station;
    station.codes = header.codes;
    station.latitude = base.latitude;
    station.longitude = base.longitude;
    station.elevation = base.altitude;
    station.profile = profile.name;
    station.is_profile_verified = profile.is_verified;
    station.product_id = header.product_id;
    station.serial_number = header.serial_number;
    station.firmware = header.firmware;
    station.output_rate_hz = header.output_rate_hz;
    station.filter = header.filter;
    station.group_delay = profile.group_delay(filter_of(profile));
    station.declared_rate_hz = header.declared_rate_hz;
    station.has_oven = station.has_outer_oven = scenario.outer_oven.has_value();
    station.start = header.clock.realtime - station.group_delay;  // The daemon does the same.
    fs::create_directories(root / "metadata");
    scenario::write_text_file(root / "metadata" / "station.xml", station::to_station_xml(station));
}

/// One answered poll of an oven's controller, which shows tenths of a degree.
journal::OvenChunk poll_of(const oven::Controller& controller, journal::OvenPlace place,
                           RawTime time) {
    const auto answer =
        controller.read(a351::oven::kFirstMonitor.two_byte, a351::oven::kMonitorCount);
    return {time, journal::OvenOutcome::answered, 1, std::get<std::vector<std::uint16_t>>(answer),
            place};
}

/// Returns the events of every occupation: start, further set-ups and stop.
std::vector<events::Event> planned_events(const std::vector<scenario::PlannedSetUp>& plan,
                                          const journal::SessionId& session) {
    std::vector<events::Event> events;
    const auto add = [&](std::string type, const scenario::PlannedSetUp& set_up, UtcTime utc) {
        events.push_back(
            {std::move(type), utc, session, std::nullopt, {{"site", set_up.site.name}}});
    };
    for (const scenario::PlannedSetUp& set_up : plan) {
        if (!set_up.is_occupied) continue;
        add(set_up.part == 1 ? "start" : "setup", set_up, set_up.start);
        if (set_up.part == set_up.parts) add("stop", set_up, set_up.end);
    }
    return events;
}

/// The daemon's end of the scenario's line: collects frames until a chunk is taken.  Each event, in
/// time order, is moved to the first sample at or after it.
class Collected final : public device::LineSink {
public:
    Collected(truth::Writer& truth, const scenario::Scenario& scenario, std::uint64_t seed,
              std::vector<events::Event> events)
        : truth_(truth),
          scenario_(scenario),
          transport_(scenario.line, seed, scenario.start()),
          events_(std::move(events)) {}

    void send(std::span<const std::byte> bytes, UtcTime leaves,
              const truth::Record* frame) override {
        chunk_.bytes.insert(chunk_.bytes.end(), bytes.begin(), bytes.end());
        transport_.carry(bytes.size(), leaves);
        const UtcTime arrives = transport_.shown_at(bytes.size());
        transport_.take(bytes.size());
        chunk_.reads.push_back(
            {static_cast<std::uint32_t>(chunk_.bytes.size()), raw_at(scenario_, arrives)});
        if (frame == nullptr) return;
        truth_.append(*frame);
        for (; next_event_ < events_.size() && events_[next_event_].utc <= frame->utc;
             ++next_event_) {
            events_[next_event_].index = frames_;
            events_[next_event_].utc = frame->utc;
        }
        ++frames_;
    }

    [[nodiscard]] bool is_full() const override { return false; }

    [[nodiscard]] bool is_empty() const noexcept { return chunk_.bytes.empty(); }
    [[nodiscard]] journal::RxChunk take() { return std::exchange(chunk_, journal::RxChunk{}); }

    [[nodiscard]] const std::vector<events::Event>& events() const noexcept { return events_; }
    [[nodiscard]] std::int64_t frames() const noexcept { return frames_; }

private:
    truth::Writer& truth_;
    const scenario::Scenario& scenario_;
    line::Transport transport_;
    journal::RxChunk chunk_;
    std::vector<events::Event> events_;
    std::size_t next_event_ = 0;
    std::int64_t frames_ = 0;
};

/// Directory in which a day is written until it is complete.  If it is left behind, the day is
/// incomplete.
class PartialRoot {
public:
    static constexpr const char* kName = "partial";

    explicit PartialRoot(const fs::path& root) : root_(root), path_(root / kName) {
        fs::create_directories(path_);
    }
    ~PartialRoot() {
        std::error_code ignored;
        if (!is_moving_) fs::remove_all(path_, ignored);
    }
    PartialRoot(const PartialRoot&) = delete;
    PartialRoot& operator=(const PartialRoot&) = delete;

    [[nodiscard]] const fs::path& path() const noexcept { return path_; }

    /// Moves the whole day to its root.
    void publish() {
        is_moving_ = true;  // An entry that cannot be moved stays, so that the failure is seen.
        const std::vector<fs::path> entries(fs::directory_iterator(path_), {});
        for (const fs::path& entry : entries) fs::rename(entry, root_ / entry.filename());
        fs::remove(path_);
    }

private:
    fs::path root_, path_;
    bool is_moving_ = false;
};

void require_no_day(const fs::path& root) {
    for (const char* name : {"journal", "archive", "events", "metadata", "truth.bin", "sites.csv",
                             "schedule.csv", "truth.csv", "survey.toml", PartialRoot::kName}) {
        if (fs::exists(root / name)) {
            throw InputError(
                fmt::format("--out {}: already holds {}; allowed: a directory without a day",
                            root.string(), name));
        }
    }
}

/// Writes survey.toml, with which a351-correct corrects the day from the tables of write_plan();
/// nothing if there are no occupations at two sites: at a single site gravity does not change, and a
/// fitted model would be meaningless.
void write_survey_file(const scenario::Scenario& scenario, std::uint64_t seed,
                       const fs::path& directory) {
    const auto is_elsewhere = [&](const scenario::ListedOccupation& one) {
        return one.site != scenario.occupations.front().site;
    };
    if (std::ranges::none_of(scenario.occupations, is_elsewhere)) return;
    scenario::write_text_file(
        directory / "survey.toml",
        fmt::format("# Simulated day; true gravity: truth.csv.  occupations = \"\" uses the event "
                    "log, which\n"
                    "# has the same times.\n"
                    "[survey]\n"
                    "name = \"{}-{}\"\n"
                    "root = \".\"\n"
                    "sites = \"sites.csv\"\n"
                    "occupations = \"schedule.csv\"\n"
                    "base = \"{}\"\n"
                    "model = \"auto\"\n"
                    "flags = \"ignore\"\n",
                    scenario.name, seed, scenario.sites.front().name));
}

DirectSurvey write_day(const scenario::Scenario& scenario, const wire::DeviceProfile& profile,
                       std::uint64_t seed, signal::Source& source, const fs::path& root,
                       const std::string& serial_number) {
    device::MachineIdentity identity;
    identity.serial_number = serial_number;
    identity.product_id = profile.product_id;
    device::RegisterMachine machine(profile, identity, Nanoseconds(0));
    start_logging(machine, device::power_on_time(profile));

    const journal::Header header = journal_header(scenario, profile, identity, seed);
    truth::Writer truth(root / "truth.bin");
    Collected collected(
        truth, scenario, seed,
        planned_events(signal::by_true_time(scenario, source.plan(), seed), header.session));
    device::DeviceStream stream(source, machine);

    files::FileLayer& files = files::posix_files();
    journal::Writer journal(files, root / "journal");
    archive::Writer archive(files, root / "archive", header.codes);
    archive::Archiver archiver(archive);
    journal.begin_segment(header);
    archiver.take(header);
    const auto take = [&](const journal::Chunk& chunk, UtcTime now) {
        if (const auto rotated = journal.append(chunk, clock_at(scenario, now)))
            archiver.take(*rotated);
        archiver.take(chunk);
    };

    // A day with a single oven has the sensor only, as the published one.
    std::optional<std::pair<oven::Controller, oven::Controller>> controllers;
    if (source.outer_oven() != nullptr)
        controllers.emplace(oven::Controller(source.oven()),
                            oven::Controller(*source.outer_oven()));
    for (UtcTime now = scenario.start() + 1s; stream.next_due(); now += 1s) {
        take(clock_at(scenario, now - 1s), now - 1s);
        stream.advance_to({now, device::power_on_time(profile)}, collected);
        if (!collected.is_empty()) take(collected.take(), now);
        if (!controllers) continue;
        take(poll_of(controllers->first, journal::OvenPlace::inner, raw_at(scenario, now)), now);
        take(poll_of(controllers->second, journal::OvenPlace::outer, raw_at(scenario, now)), now);
    }
    archiver.close_records();
    journal.sync();
    static_cast<void>(archive.sync());
    truth.close();

    write_plan(scenario, seed, root);
    write_station_xml(scenario, profile, header, root);
    for (const events::Event& event : collected.events())
        events::append_event(files, root / "events", event);
    write_survey_file(scenario, seed, root);
    return {collected.frames(), static_cast<std::int64_t>(archive.records_written())};
}

}  // namespace

void write_plan(const scenario::Scenario& scenario, std::uint64_t seed, const fs::path& directory) {
    const std::vector<scenario::PlannedSetUp> plan = scenario::plan_survey(scenario, seed);
    const std::string truth = signal::truth_csv(scenario, plan, seed);
    fs::create_directories(directory);
    scenario::write_text_file(directory / "sites.csv", scenario::sites_csv(scenario));
    scenario::write_text_file(directory / "schedule.csv",
                              scenario::schedule_csv(signal::by_true_time(scenario, plan, seed)));
    scenario::write_text_file(directory / "truth.csv", truth);
}

DirectSurvey write_survey(const scenario::Scenario& scenario, const wire::DeviceProfile& profile,
                          std::uint64_t seed, const fs::path& root,
                          const std::string& serial_number) {
    require_no_day(root);
    signal::Source source(scenario, profile, seed);
    PartialRoot partial(root);
    const DirectSurvey survey =
        write_day(scenario, profile, seed, source, partial.path(), serial_number);
    partial.publish();
    return survey;
}

}  // namespace a351::sim::survey
