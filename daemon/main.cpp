#include <signal.h>
#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/config.hpp"
#include "daemon/config/verdict_config.hpp"
#include "daemon/gravity/gravity_so_far.hpp"
#include "daemon/identify/asking.hpp"
#include "daemon/identify/identify_file.hpp"
#include "daemon/identify/report.hpp"
#include "daemon/live/live_record.hpp"
#include "daemon/page/server.hpp"
#include "daemon/recorder/day_file.hpp"
#include "daemon/recorder/reload.hpp"
#include "daemon/recorder/snapshot.hpp"
#include "daemon/service/process_setup.hpp"
#include "daemon/service/service_notice.hpp"
#include "daemon/source/host_clock.hpp"
#include "daemon/source/ovens.hpp"
#include "daemon/source/port.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/source/sensor_link.hpp"
#include "daemon/status/recovery_log.hpp"
#include "daemon/status/status.hpp"
#include "daemon/status/status_log.hpp"
#include "daemon/store/store.hpp"
#include "daemon/survey/occupations.hpp"
#include "daemon/survey/operator_signal.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/normal_gravity.hpp"
#include "protocol/text/doubtful_site.hpp"
#include "protocol/text/message.hpp"

namespace {

using namespace a351;
using namespace a351::daemon;

enum ExitStatus { kDone = 0, kFailed = 1, kBadUsage = 2, kAlreadyRunning = 3, kDiffers = 4 };

std::shared_ptr<spdlog::logger> make_log() {
    // A full log queue must not stop the acquisition, so the oldest lines are dropped.  Its memory
    // is filled at once: 4096 lines would take 1.6 MB of the daemon's 11.
    spdlog::init_thread_pool(256, 1);
    auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    auto log = std::make_shared<spdlog::async_logger>(
        "a351d", sink, spdlog::thread_pool(), spdlog::async_overflow_policy::overrun_oldest);
    log->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %n %l: %v");
    log->flush_on(spdlog::level::info);
    return log;
}

/// Writes all log lines before the program ends, however it ends.
struct LogEnd {
    ~LogEnd() { spdlog::shutdown(); }
};

live::PlacedSample placed(const archive::Sample& sample, UtcTime time) {
    const auto& axes = sample.values.axes;
    return {sample.index, time, {axes[0], axes[1], axes[2], sample.values.temperature}};
}

void recall_past(const config::Config& config, UtcTime now, spdlog::logger& log,
                 live::Record& live) {
    try {
        live::take_archived_past(config.storage.root / "archive", config.station.codes, now, live);
    } catch (const std::exception& error) {
        log.warn("archived data could not be loaded, the signal starts without them: {}",
                 error.what());
    }
}

/// Logs what is doubtful in the list of sites, after it was read.
void log_doubt(const survey::Occupations& occupations, spdlog::logger& log) {
    if (const text::Message& doubt = occupations.doubtful_site(); !doubt.empty())
        log.warn("{}: {}", occupations.sites_file().string(), doubt.english());
}

/// Reads the configuration again after SIGHUP.
void hang_up(const config::Config& config, const recorder::ReloadedParts& parts,
             spdlog::logger& log) {
    try {
        recorder::reload(config, parts, [&] { log_doubt(parts.occupations, log); });
        log.info(
            "SIGHUP: [verdict], sites, occupation_min, set_ups and faces were read again and are "
            "in use");
    } catch (const std::exception& error) {
        log.error("SIGHUP: the configuration was refused and nothing was changed: {}",
                  error.what());
    }
}

page::ServerOptions page_options(const config::Config& config) {
    return {.listen = config.page.listen,
            .hosts = config.page.hosts,
            .token = config.page.token,
            .boxes = config.page.boxes};
}

void announce(const page::Server& page, const config::Config& config, spdlog::logger& log) {
    for (const std::string& address : page.addresses()) log.info("page at http://{}", address);
    if (page.is_exposed())
        log.warn("the page can be reached from other hosts; changes need the token");
    if (config::shows_token(config)) {
        log.warn("every user of this computer can read the token in {}; chmod o-r {}",
                 config.file.string(), config.file.string());
    }
}

/// Reports the state of the recorder once a second, until a signal ends the program.
void report_until_end(const recorder::Parts& parts, service::ServiceNotice& notice,
                      status::StatusLog& status_log, const sigset_t& signals,
                      const std::function<void()>& each_second,
                      const std::function<void()>& hang_up) {
    constexpr timespec kSecond{1, 0};
    int signal = 0;
    while (signal != SIGINT && signal != SIGTERM) {
        signal = sigtimedwait(&signals, nullptr, &kSecond);
        const status::Status status = recorder::snapshot(parts);
        status_log.note(status, std::chrono::steady_clock::now());
        notice.beat(parts.store.is_alive(), status::brief(status));
        each_second();
        if (signal == SIGHUP) hang_up();
    }
}

/// Logs unfinished work at the end.
/// @param is_on_disk  result of Store::stop().
ExitStatus report_end(store::Store& store, bool is_on_disk, bool is_recovered,
                      spdlog::logger& log) {
    if (!is_recovered)
        log.warn(
            "the archive is incomplete; the next start adds the missing data from the journal");
    if (is_on_disk) return kDone;
    status::Status end;  // A fault of the last second has not been logged.
    store.fill(end);
    for (const auto& reason : end.reasons) log.error("{}", reason.english());
    log.error("some data could not be written to disk or archived, for the reasons above");
    return kFailed;
}

ExitStatus run(const config::Config& config, const source::HostClock& clock, spdlog::logger& log,
               const sigset_t& signals, status::StatusLog& status_log) {
    service::ServiceNotice notice = service::ServiceNotice::from_environment();
    source::ReadQueue reads;
    live::Record live(*config.sensor.profile, config.station.output_rate_hz, config.verdict);
    std::atomic<bool> is_recovered{false};
    std::optional<UtcTime> exchange;  // This and the next one are set before the store starts.
    std::function<void(const events::Event&)> other_unit;
    const auto files = files::files_below(config.storage.root);
    store::Store store(*files,
                       {.root = config.storage.root,
                        .station = config.station,
                        .keeper = {.keep_days = config.storage.journal_keep_days},
                        .recovered =
                            [&](const auto& report) {
                                status::log_recovery(log, report);
                                live.end_of_history();
                                if (exchange) live.begin_unit(*exchange);
                                is_recovered = true;
                            },
                        .begin = [&] { recall_past(config, clock.read().realtime, log, live); },
                        .other_unit = [&](const auto& event) { other_unit(event); },
                        .sample = [&](const archive::Sample& sample,
                                      UtcTime time) { live.take(placed(sample, time)); }},
                       clock, reads);
    source::LinkOptions sensor = config.sensor;
    sensor.header = config::journal_header(config, clock);
    sensor.known = store.known_stream();
    source::SensorLink link(std::move(sensor), clock, reads);
    const auto take_poll = [&](journal::OvenChunk poll) {
        if (const auto point = live::oven_point(poll, clock.read().realtime)) live.take(*point);
        store.post(std::move(poll));
    };
    source::Ovens ovens;
    if (config.oven) ovens.inner.emplace(*config.oven, clock, take_poll);
    if (config.outer_oven) ovens.outer.emplace(*config.outer_oven, clock, take_poll);
    const recorder::Parts parts{config, clock, link, ovens, store, live};
    const auto snapshot = [&] { return recorder::snapshot(parts); };
    const std::filesystem::path events = config.storage.root / "events";
    const events::EventLog read = events::read_events(events);
    for (const events::EventDamage& damage : read.damage)
        log.warn("{}:{}: not an event, left out: a line that was torn by a power cut, or an edit",
                 damage.file.string(), damage.line);
    const std::vector<events::Event>& logged = read.events;
    exchange = live::last_exchange(logged);
    survey::Occupations occupations(store, config.survey.sites, logged,
                                    recorder::occupation_options(config));
    gravity::GravityOptions computation = recorder::gravity_options(config);
    computation.failed = [&](const std::string& reason, const std::string& cause) {
        log.warn("no gravity so far: {}: {}", reason, cause);
    };
    gravity::GravitySoFar gravity(std::move(computation));
    const auto note_change = [&] {
        gravity.note_change(occupations.running().has_value());
        store.set_day_end(occupations.day_end());
    };
    if (occupations.running() || !occupations.list().empty()) note_change();
    const auto note = [&](const events::Event& event) { store.note(event); };
    survey::SoFarReader reader(logged, note);
    const auto so_far = [&] { return reader.read(gravity.document()); };
    survey::SignalLog signal_log(occupations, live, note);
    survey::Word word = survey::Word::no_data;  // The page's thread uses it.
    const auto log_signal = [&] {
        if (!is_recovered) return;  // The last run has logged the words of what its journal left.
        const auto now = signal_log.advance(snapshot(), so_far());
        const bool is_complete = now == survey::Word::go && occupations.running();
        if (is_complete && now != word) gravity.note_change(true);
        word = now;
    };
    const auto not_copied = [&](const std::string& cause) {
        log.error("the day could not be copied: {}", cause);
    };
    page::Server page(page_options(config),
                      {.status = snapshot,
                       .occupations = occupations,
                       .live = live,
                       .latitude = config.station.latitude,
                       .longitude = config.station.longitude,
                       .events = [&] { return events::read_events(events).events; },
                       .gravity_so_far = [&] { return gravity.document(); },
                       .so_far = so_far,
                       .bundle =
                           [&] {
                               return recorder::bundle_of_day(config, clock.read().realtime,
                                                              occupations, gravity.document(),
                                                              not_copied);
                           },
                       .changing = log_signal,
                       .changed = note_change,
                       .assets = config.page.assets,
                       .boxes = config.page.boxes,
                       .stale_after = config::stale_after(clock)});
    announce(page, config, log);
    log_doubt(occupations, log);
    const recorder::ReloadedParts reloaded{live, occupations, gravity, page};
    other_unit = [&](const events::Event& event) {
        live.begin_unit(event.utc);
        page.post([&occupations, &note_change, &log_signal, event] {
            log_signal();
            occupations.end_at_exchange(event);
            note_change();
        });
    };
    store.start();
    link.start();
    ovens.start();
    page.start();
    gravity.start();
    notice.ready();
    report_until_end(
        parts, notice, status_log, signals, [&] { page.post(log_signal); },
        [&] { hang_up(config, reloaded, log); });
    log.info("stopping");
    notice.stopping();
    page.stop();
    ovens.stop();
    link.stop();
    const bool is_on_disk = store.stop();
    gravity.stop();  // It waits for its child, which a failing disk may hold.
    return report_end(store, is_on_disk, is_recovered, log);
}

int complain_and_end(ExitStatus status, const std::string& trouble) {
    std::fprintf(stderr, "a351d: %s\n", trouble.c_str());
    return status;
}

/// Compares the sensor with the configuration, and writes a file about it to the working directory.
ExitStatus identify_sensor(const config::Config& config, const source::HostClock& clock) {
    std::puts("asking the sensor; leave the box at rest for a minute");
    std::fflush(stdout);
    const identify::Observation seen = identify::ask_sensor(config.sensor, clock);
    if (!seen.has_answered) {
        complain_and_end(kFailed, identify::explain_silence(seen));
        return kFailed;
    }
    const identify::Report report =
        identify::report_on(seen, {.profile = config.sensor.profile,
                                   .settings = config.sensor.settings,
                                   .baud = config.sensor.baud,
                                   .serial_number = config.sensor.expected_serial_number,
                                   .axes = config.station.codes.axes,
                                   .gravity = to_standard_gravity(normal_gravity(
                                       config.station.latitude, config.station.elevation))});
    const std::string stem = identify::write_files(".", seen, report);
    std::fputs(identify::to_text(report).c_str(), stdout);
    std::fputs(identify::advice(report, config.sensor.profile->name, stem).c_str(), stdout);
    return report.differs() ? kDiffers : kDone;
}

}  // namespace

int main(int argc, char** argv) {
    service::open_standard_streams();
    CLI::App app("Records data from an M-A351 accelerometer and reports its state to the operator.",
                 "a351d");
    app.set_version_flag("--version", std::string("a351d ") + A351_VERSION);
    std::string config_file;
    std::string clock_text;
    bool is_check = false;
    bool is_list = false;
    bool is_identify = false;
    app.add_option("--config", config_file, "Configuration file (TOML)")->type_name("FILE");
    app.add_flag("--check-config", is_check, "Check the configuration, print ok, and exit");
    app.add_option("--clock", clock_text,
                   "Simulated time, scaled:FACTOR@UTC[,HOST]: UTC + FACTOR x (host clock - HOST); "
                   "default of HOST: now")
        ->type_name("SCALE");
    app.add_flag("--list-ports", is_list,
                 "List the serial ports (path, by-id name, USB VID:PID:SERIAL) and exit");
    app.add_flag(
        "--identify", is_identify,
        "Ask the sensor for a minute, without recording, compare it with the configuration, "
        "write identify-SERIAL-TIME.txt to the working directory, and exit");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        return complain_and_end(kBadUsage, error.what());
    }

    try {
        if (is_list) {
            std::fputs(source::port_table(source::list_serial_ports()).c_str(), stdout);
            return kDone;
        }
        if (config_file.empty()) return complain_and_end(kBadUsage, "--config FILE is required");
        std::optional<ClockScale> scale;
        if (!clock_text.empty()) {
            scale = parse_clock_scale(clock_text, source::host_realtime());
            if (!scale) {
                return complain_and_end(
                    kBadUsage, "--clock = " + clock_text +
                                   ": not a clock scale; allowed: scaled:FACTOR@UTC[,HOST]");
            }
        }
        const config::Config config = config::read_config(config_file);
        if (is_check) {
            const auto station = recorder::occupation_options(config).station;
            if (const auto doubt = text::doubtful_site(config.survey.sites, &*station);
                !doubt.empty())
                fmt::print(stderr, "a351d: {}: {}\n", config.survey.sites_file.string(),
                           text::in_words(doubt));
            std::puts("ok");
            return kDone;
        }
        if (is_identify) return identify_sensor(config, source::HostClock(scale));
        const sigset_t signals = service::block_signals();
        const auto log = make_log();
        const LogEnd end;
        status::StatusLog status_log(log);
        return run(config, source::HostClock(scale), *log, signals, status_log);
    } catch (const InputError& error) {
        return complain_and_end(kBadUsage, error.what());
    } catch (const store::DataRootLocked& error) {
        return complain_and_end(kAlreadyRunning, error.what());
    } catch (const source::PortError& error) {
        const bool is_locked = error.kind() == source::PortError::Kind::locked;
        return complain_and_end(is_locked ? kAlreadyRunning : kFailed, error.what());
    } catch (const std::exception& error) {
        return complain_and_end(kFailed, error.what());
    }
}
