#include "tests/simulation/simulation.hpp"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/events/event_log.hpp"
#include "sim/line/fault.hpp"
#include "tests/simulation/recorder.hpp"
#include "tests/support/temporary_directory.hpp"

namespace a351::simulation {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Outcome, broken, signal_s, simulated_s, faults, runs, samples,
                                   promised, archived, events, turns, digest)

namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kSignal = 600s;
constexpr double kMeanFaultWait_s = 10.0;
constexpr double kMeanLife_s = 60.0;
constexpr unsigned kLongest_s = 120;  // Real time, after which a run counts as crashed.

/// Faults of sensor and line, in the words of a fault script.  {} is a random number.
constexpr std::array kLineFaults{"flip_bit count={}",
                                 "bad_checksum count={}",
                                 "drop_bytes count={}",
                                 "insert_bytes count={}",
                                 "garbage bytes={}",
                                 "duplicate_frame count={}",
                                 "reorder_frames count={}",
                                 "truncate_frame count={}",
                                 "lose_frames count={}",
                                 "counter_jump count={}",
                                 "counter_reset",
                                 "reset",
                                 "power_cycle",
                                 "stop",
                                 "silence seconds={}",
                                 "stall seconds={}",
                                 "hang_up seconds={}"};

double seconds(Nanoseconds span) { return std::chrono::duration<double>(span).count(); }

class Simulation {
public:
    /// Takes the outcome and ends the process, because recorders may have locks and half-done calls.
    using End = std::function<void(const Outcome&)>;

    Simulation(std::uint64_t seed, bool is_traced, End end)
        : end_(std::move(end)),
          is_traced_(is_traced),
          random_(seed, "world"),
          schedule_(seed),
          host_(seed, schedule_, start(), directory_.path()),
          disk_(seed, schedule_, host_, directory_.path() / "data"),
          sensor_(seed, schedule_, host_, line()),
          world_{.seed = seed,
                 .schedule = schedule_,
                 .host = host_,
                 .disk = disk_,
                 .sensor = sensor_,
                 .root = directory_.path() / "data",
                 .promises = promises_,
                 .broken = [this](const std::string& what) { fail(what); },
                 .is_traced = is_traced} {
        schedule_.stuck = world_.broken;
    }

    void run() {
        start_of_run_ = host_.true_time();
        while (signal_ < kSignal) {
            begin();
            live(from_seconds(kMeanLife_s * random_.exponential()));
            end();
        }
        settle();
        end_(outcome());
    }

    [[nodiscard]] Outcome outcome();

private:
    UtcTime start() {
        // Within the hour before a midnight.
        return *parse_rfc3339("2026-02-28T23:00:00Z") + from_seconds(random_.uniform(0.0, 3500.0));
    }
    sim::scenario::LineParameters line() {
        sim::scenario::LineParameters parameters;
        parameters.latency_timer_ms = random_.uniform() < 0.5 ? 1.0 : 16.0;
        parameters.jitter_ms = random_.uniform(0.0, 3.0);
        return parameters;
    }
    void say(const std::string& text) const {
        if (is_traced_) std::fprintf(stderr, "%12.6f %s\n", seconds(schedule_.now()), text.c_str());
    }

    [[noreturn]] void fail(const std::string& what) {
        outcome_.broken = what;
        end_(outcome());
        std::abort();
    }
    void begin();
    void live(Nanoseconds span);
    void end();
    void settle();
    void cause_fault();
    void wait(Nanoseconds span) { schedule_.sleep_until(schedule_.now() + span); }
    void wait_for_recovery();
    void check_archive(const char* when);
    void note_due();
    [[nodiscard]] std::vector<std::int64_t> numbers_in(const archive::ChannelData& data,
                                                       std::size_t axis, const std::string& where);

    End end_;
    Outcome outcome_;
    bool is_traced_;
    sim::noise::RandomStream random_;
    test::TemporaryDirectory directory_;
    Schedule schedule_;
    Host host_;
    SimulatedDisk disk_;
    SimulatedSensor sensor_;
    Promises promises_;
    World world_;
    std::unique_ptr<Recorder> recorder_;
    int program_ = 0;
    bool must_check_ = false;
    bool is_counter_reset_ = false;  ///< The sensor's counter restarted while it sampled.
    UtcTime start_of_run_;
    Nanoseconds signal_{0};
    std::vector<std::int64_t> due_samples_;  ///< Promised before the present run, in order.
    std::vector<std::string> due_events_;
};

/// Notes the data that archive and event log must have from now on.
void Simulation::note_due() {
    auto& samples = promises_.samples;
    std::ranges::sort(samples);
    const auto repeated = std::ranges::unique(samples);
    samples.erase(repeated.begin(), repeated.end());
    due_samples_ = samples;
    due_events_ = promises_.events;
}

/// Starts a recorder.  One that cannot start because of the disk is started again after a while, as
/// systemd does.
void Simulation::begin() {
    while (true) {
        note_due();
        disk_.forget_holes();  // The start must repair them.
        program_ = schedule_.begin_program();
        ++outcome_.runs;
        try {
            recorder_ = std::make_unique<Recorder>(world_, outcome_.runs);
            recorder_->start();
            must_check_ = true;
            return;
        } catch (const std::system_error& error) {
            say(fmt::format("no start: {}", error.what()));
            if (!disk_.is_in_trouble()) fail(fmt::format("it does not start: {}", error.what()));
        }
        host_.release_locks();
        wait(5s);
    }
}

void Simulation::live(Nanoseconds span) {
    const Nanoseconds begin = schedule_.now();
    const Nanoseconds end = begin + span;
    while (schedule_.now() < end) {
        wait(std::min(end - schedule_.now(),
                      from_seconds(kMeanFaultWait_s * random_.exponential())));
        if (must_check_ && recorder_->is_recovered() && !disk_.is_in_trouble()) {
            must_check_ = false;
            check_archive("after a start");
        }
        if (schedule_.now() < end) cause_fault();
    }
    signal_ += schedule_.now() - begin;
}

void Simulation::cause_fault() {
    ++outcome_.faults;
    const double choice = random_.uniform();
    if (choice < 0.55) {
        const char* const words = kLineFaults.at(random_.bits() % kLineFaults.size());
        const std::string fault =
            fmt::format(fmt::runtime(words), 1 + static_cast<int>(3.0 * random_.exponential()));
        say(fault);
        is_counter_reset_ |= fault == "counter_reset";
        sensor_.apply(sim::line::parse_fault(fault, {.profile = *wire::find_profile("A351")}));
    } else if (choice < 0.85) {
        const auto kind = static_cast<SimulatedDisk::Trouble>(1 + random_.bits() % 3);
        const auto part = static_cast<SimulatedDisk::Part>(random_.bits() % 3);
        const Nanoseconds span = from_seconds(4.0 * random_.exponential());
        say(fmt::format("disk trouble {} of part {} for {:.3f} s", static_cast<int>(kind),
                        static_cast<int>(part), seconds(span)));
        disk_.trouble(kind, part, schedule_.now() + span);
    } else if (choice < 0.88) {
        host_.switch_synchronisation();
        say(host_.is_synchronised() ? "the clock is synchronised"
                                    : "the clock is not synchronised");
    } else if (choice < 0.94) {
        const Nanoseconds by = from_seconds(random_.uniform(-90.0, 90.0));
        say(fmt::format("clock step of {:.3f} s", seconds(by)));
        host_.step_clock(by);
    } else {
        const Nanoseconds span = from_seconds(600.0 * random_.exponential());
        say(fmt::format("the host sleeps for {:.0f} s", seconds(span)));
        host_.sleep(span);
        sensor_.pass_unheard();
    }
}

/// Ends the recorder: by a kill, a power cut or SIGTERM; then passes a time without it.
void Simulation::end() {
    const double choice = random_.uniform();
    if (choice < 0.3) {
        say("SIGTERM");
        if (!recorder_->stop() && schedule_.now() - disk_.trouble_end() > 60s)
            fail("an orderly end did not write everything");
        recorder_.reset();
    } else {
        say(choice < 0.65 ? "kill" : "power cut");
        schedule_.kill_program(program_);
        static_cast<void>(recorder_.release());  // Its threads and locks are as they were.
        host_.release_locks();
        if (choice >= 0.65) {
            disk_.cut_power();
            host_.boot();
        }
    }
    if (random_.uniform() < 0.3) {
        host_.sleep(from_seconds(7200.0 * random_.exponential()));
        sensor_.pass_without_power();
    }
    wait(from_seconds(2.0 * random_.exponential()));
}

/// Starts a last recorder on a healthy host, which must find everything and have no trouble.
void Simulation::settle() {
    if (!host_.is_synchronised()) host_.switch_synchronisation();
    disk_.trouble(SimulatedDisk::Trouble::none, SimulatedDisk::Part::all, schedule_.now());
    begin();
    wait_for_recovery();
    check_archive("at the end");
    wait(120s);
    const auto status = recorder_->status();
    for (const std::string& reason : status.reasons) {
        // A counter that restarted can look like a gap of up to a second, which stays.
        if (!is_counter_reset_ || !reason.starts_with("the samples are later than the clock"))
            fail("trouble without a reason: " + reason);
    }
    note_due();
    if (!recorder_->stop()) fail("the last orderly end did not write everything");
    recorder_.reset();
    check_archive("after the last end");
}

void Simulation::wait_for_recovery() {
    const Nanoseconds begin = schedule_.now();
    while (!recorder_->is_recovered()) {
        wait(500ms);
        if (schedule_.now() - begin > 120s) fail("the recovery does not end");
    }
}

/// Reads the archive and the event log as a stranger does, while the recorder runs.
void Simulation::check_archive(const char* when) {
    const std::array channels{"BN1", "BN2", "BNZ"};
    for (std::size_t axis = 0; axis < channels.size(); ++axis) {
        const auto data = archive::read_channel(world_.root / "archive", {}, channels.at(axis),
                                                UtcTime::min(), UtcTime::max());
        const std::string where = fmt::format("{}, {}", when, channels.at(axis));
        for (const archive::Damage& damage : data.damage)
            if (!disk_.has_holes(damage.file))
                fail(fmt::format("{}: {}", where, archive::to_text(damage)));
        const std::vector<std::int64_t> found = numbers_in(data, axis, where);
        std::vector<std::int64_t> missing;
        std::ranges::set_difference(due_samples_, found, std::back_inserter(missing));
        // The newest can be in a record that is not full yet.
        if (!recorder_ ? !missing.empty()
                       : !missing.empty() && !found.empty() && missing.front() < found.back()) {
            fail(fmt::format("{}: {} samples that were promised are lost: {} to {}", where,
                             missing.size(), missing.front(), missing.back()));
        }
        outcome_.archived = static_cast<std::int64_t>(found.size());
    }
    std::map<std::string, int> lines;
    for (const auto& event : events::read_events(world_.root / "events").events)
        ++lines[events::to_json(event)];
    for (const std::string& event : due_events_)
        if (!lines.contains(event)) fail(fmt::format("{}: event lost: {}", when, event));
    say(fmt::format("{}: {} samples, {} promised, {} events", when, outcome_.archived,
                    due_samples_.size(), lines.size()));
}

/// Returns the numbers of the samples of an axis, in order.  Each must have arrived, and be there
/// once.
std::vector<std::int64_t> Simulation::numbers_in(const archive::ChannelData& data, std::size_t axis,
                                                 const std::string& where) {
    std::vector<std::int64_t> found;
    for (const archive::Segment& segment : data.segments) {
        for (const std::int32_t counts : segment.counts) {
            const auto number = NumberedSamples::number(axis, counts);
            if (!number || !sensor_.may_be_archived(*number))
                fail(fmt::format("{}: a sample of {} counts was invented", where, counts));
            found.push_back(*number);
        }
    }
    std::ranges::sort(found);
    if (const auto twice = std::ranges::adjacent_find(found); twice != found.end())
        fail(fmt::format("{}: sample {} is there twice", where, *twice));
    return found;
}

Outcome Simulation::outcome() {
    outcome_.signal_s = seconds(signal_);
    outcome_.simulated_s = seconds(host_.true_time() - start_of_run_);
    outcome_.samples = sensor_.samples();
    note_due();
    outcome_.promised = static_cast<std::int64_t>(due_samples_.size());
    outcome_.events = promises_.events.size();
    outcome_.turns = schedule_.turns();
    outcome_.digest = schedule_.digest();
    std::error_code ignored;
    if (is_traced_)
        say("the files are kept in " + directory_.path().string());
    else
        std::filesystem::remove_all(directory_.path(), ignored);
    return outcome_;
}

/// Writes all bytes, or the rest is missing.
void write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const auto written = ::write(descriptor, text.data(), text.size());
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

Outcome outcome_of(const std::string& text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    Outcome outcome;
    if (json.is_discarded())
        outcome.broken = "the simulated process crashed";
    else
        json.get_to(outcome);
    return outcome;
}

}  // namespace

Outcome simulate(std::uint64_t seed, bool is_traced) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    const pid_t child = ::fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        ::alarm(kLongest_s);
        Simulation simulation(seed, is_traced, [&](const Outcome& outcome) {
            write_all(ends[1], nlohmann::json(outcome).dump());
            ::_exit(0);
        });
        simulation.run();
    }
    ::close(ends[1]);
    std::string text;
    std::array<char, 4096> part{};
    for (ssize_t count = 0; (count = ::read(ends[0], part.data(), part.size())) > 0;)
        text.append(part.data(), static_cast<std::size_t>(count));
    ::close(ends[0]);
    ::waitpid(child, nullptr, 0);
    return outcome_of(text);
}

}  // namespace a351::simulation
