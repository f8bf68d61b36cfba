#include "sim/survey/direct_survey.hpp"

#include <optional>
#include <span>
#include <utility>

#include "protocol/core/input_error.hpp"
#include "protocol/record/archive_writer.hpp"
#include "protocol/record/archiver.hpp"
#include "protocol/record/event_log.hpp"
#include "protocol/record/journal_writer.hpp"
#include "protocol/record/station_xml.hpp"
#include "protocol/wire/commands.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/signal_source.hpp"
#include "sim/survey/plan_files.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr std::string_view kFilterName = "k512_fc9";
constexpr int kBaud = 460800;

/// Of the imagined host, which was started an hour before the record.
constexpr Nanoseconds kHostUptime = 1h;
constexpr std::string_view kBootId = "00000000-0000-4000-8000-000000000351";

/// NTP over a good network keeps a host within this.
constexpr std::int64_t kHostClockErrorUs = 100;

RawTime raw_at(const Scenario& scenario, UtcTime utc) {
    return RawTime(kHostUptime + (utc - scenario.start()));
}

timing::ClockReading clock_at(const Scenario& scenario, UtcTime utc) {
    timing::ClockReading reading;
    reading.raw = raw_at(scenario, utc);
    reading.boottime = reading.raw.time_since_epoch();
    reading.realtime = utc;
    reading.is_synchronised = true;
    reading.max_error_us = reading.estimated_error_us = kHostClockErrorUs;
    return reading;
}

record::JournalHeader journal_header(const Scenario& scenario, const wire::DeviceProfile& profile,
                                     const MachineIdentity& identity, std::uint64_t seed) {
    record::JournalHeader header;
    RandomStream session(seed, "session");
    for (std::uint8_t& byte : header.session.bytes) {
        byte = static_cast<std::uint8_t>(session.bits() >> 56U);
    }
    header.boot_id = kBootId;
    header.program_version = A351_VERSION;
    header.profile = profile.name;
    header.product_id = identity.product_id;
    header.serial_number = identity.serial_number;
    header.firmware = identity.firmware;
    header.output_rate_hz = SignalSource::kRateHz;
    header.filter = kFilterName;
    header.burst_ctrl = wire::BurstLayout::recommended().burst_ctrl();
    header.baud = kBaud;
    header.clock = clock_at(scenario, scenario.start());
    return header;
}

/// As the daemon does: 50 Hz, k512_fc9, automatic frames with every field.
void start_logging(RegisterMachine& machine, Nanoseconds now) {
    std::vector<std::byte> answers;
    const auto config = *wire::ConfigMode::from_mode_ctrl(wire::kModeStatConfig);
    const auto send = [&](const wire::CommandSequence& commands) {
        for (const wire::Command& command : commands) machine.receive(command, now, answers);
    };
    send(config.write(wire::kSmplCtrl, 0x0600, wire::kHighByte));
    send(config.write(wire::kFilterCtrl, 0x0006, wire::kFilterSelect));
    send(config.write(wire::kUartCtrl, wire::kUartAuto, wire::kLowByte));
    send(config.write(wire::kBurstCtrl, wire::BurstLayout::recommended().burst_ctrl(),
                      wire::kBothBytes));
    send(wire::ConfigMode(config).start_sampling().second);
}

void write_station_xml(const Scenario& scenario, const wire::DeviceProfile& profile,
                       const record::JournalHeader& header, const fs::path& root) {
    const text::Site& base = scenario.sites.front();
    record::StationDescription station;
    station.codes = header.codes;
    station.latitude = base.latitude;
    station.longitude = base.longitude;
    station.elevation = base.altitude;
    station.start = scenario.start();
    station.profile = profile.name;
    station.is_profile_verified = profile.is_verified;
    station.product_id = header.product_id;
    station.serial_number = header.serial_number;
    station.firmware = header.firmware;
    station.output_rate_hz = header.output_rate_hz;
    station.filter = header.filter;
    station.group_delay = profile.group_delay(*profile.filter_named(kFilterName));
    fs::create_directories(root / "metadata");
    write_text_file(root / "metadata" / "station.xml", record::to_station_xml(station));
}

/// Start, further set-ups and stop of every occupation, at the first sample at or after the instant.
void write_events(const std::vector<PlannedSetUp>& plan, const record::SessionId& session,
                  UtcTime first_sample, const fs::path& root) {
    const auto append = [&](std::string type, const PlannedSetUp& set_up, UtcTime utc) {
        record::Event event;
        event.type = std::move(type);
        event.session = session;
        const Nanoseconds spacing = Nanoseconds(1s) / SignalSource::kRateHz;
        event.index = (utc - first_sample + spacing - Nanoseconds(1)) / spacing;
        event.utc = first_sample + *event.index * spacing;
        event.details = {{"site", set_up.site.name}};
        record::append_event(record::posix_files(), root / "events", event);
    };
    for (const PlannedSetUp& set_up : plan) {
        if (!set_up.is_occupied) continue;
        append(set_up.part == 1 ? "start" : "setup", set_up, set_up.start);
        if (set_up.part == set_up.parts) append("stop", set_up, set_up.end);
    }
}

/// The daemon's end of a line without delay: frames are gathered until a chunk is taken.
class Collected final : public LineSink {
public:
    Collected(TruthWriter& truth, const Scenario& scenario) : truth_(truth), scenario_(scenario) {}

    void send(std::span<const std::byte> bytes, UtcTime leaves, const TruthRecord* frame) override {
        chunk_.bytes.insert(chunk_.bytes.end(), bytes.begin(), bytes.end());
        chunk_.reads.push_back(
            {static_cast<std::uint32_t>(chunk_.bytes.size()), raw_at(scenario_, leaves)});
        if (frame == nullptr) return;
        truth_.append(*frame);
        if (!first_sample_) first_sample_ = frame->utc;
        ++frames_;
    }

    [[nodiscard]] bool is_full() const override { return false; }

    [[nodiscard]] bool is_empty() const noexcept { return chunk_.bytes.empty(); }
    [[nodiscard]] record::RxChunk take() { return std::exchange(chunk_, record::RxChunk{}); }

    [[nodiscard]] std::optional<UtcTime> first_sample() const noexcept { return first_sample_; }
    [[nodiscard]] std::int64_t frames() const noexcept { return frames_; }

private:
    TruthWriter& truth_;
    const Scenario& scenario_;
    record::RxChunk chunk_;
    std::optional<UtcTime> first_sample_;
    std::int64_t frames_ = 0;
};

void write_survey_file(const Scenario& scenario, const fs::path& root) {
    write_text_file(
        root / "survey.toml",
        "# Simulated day; true gravity: truth.csv.  occupations = \"\" takes the event log,\n"
        "# which has the same times.\n"
        "[survey]\n"
        "name = \"" +
            scenario.name +
            "\"\n"
            "root = \".\"\n"
            "sites = \"sites.csv\"\n"
            "occupations = \"schedule.csv\"\n"
            "base = \"" +
            scenario.sites.front().name +
            "\"\n"
            "model = \"auto\"\n"
            "flags = \"ignore\"\n");
}

}  // namespace

DirectSurvey write_survey(const Scenario& scenario, const wire::DeviceProfile& profile,
                          std::uint64_t seed, const fs::path& root) {
    if (fs::exists(root / "journal")) {
        throw InputError("--out " + root.string() +
                         ": already holds a journal; allowed: a directory without one");
    }
    SignalSource source(scenario, profile, seed);
    fs::create_directories(root);
    MachineIdentity identity;
    identity.product_id = product_id_of(profile);
    RegisterMachine machine(profile, identity, Nanoseconds(0));
    start_logging(machine, RegisterMachine::kPowerOnTime);

    TruthWriter truth(root / "truth.bin");
    Collected collected(truth, scenario);
    DeviceStream stream(source, machine);

    record::FileLayer& files = record::posix_files();
    const record::JournalHeader header = journal_header(scenario, profile, identity, seed);
    record::JournalWriter journal(files, root / "journal");
    record::ArchiveWriter archive(files, root / "archive", header.codes);
    record::Archiver archiver(archive);
    journal.begin_segment(header);
    archiver.take(header);
    const auto take = [&](const record::JournalChunk& chunk, UtcTime now) {
        journal.append(chunk, clock_at(scenario, now));
        archiver.take(chunk);
    };

    for (UtcTime now = scenario.start() + 1s; stream.next_due(); now += 1s) {
        take(clock_at(scenario, now - 1s), now - 1s);
        stream.advance_to({now, RegisterMachine::kPowerOnTime}, collected);
        if (!collected.is_empty()) take(collected.take(), now);
    }
    archiver.close_records();
    journal.sync();
    static_cast<void>(archive.sync());
    truth.close();

    write_plan(scenario, seed, root);
    write_station_xml(scenario, profile, header, root);
    write_events(source.plan(), header.session, *collected.first_sample(), root);
    if (!scenario.fixed_record) write_survey_file(scenario, root);
    return {collected.frames(), static_cast<std::int64_t>(archive.records_written())};
}

}  // namespace a351::sim
