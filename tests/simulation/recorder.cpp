#include "tests/simulation/recorder.hpp"

#include <fmt/core.h>
#include <malloc.h>
#include <spdlog/sinks/base_sink.h>

#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "protocol/events/event_log.hpp"

namespace a351::simulation {
namespace {

using namespace std::chrono_literals;
using daemon::status::Status;

// Limit of the memory that a run takes beyond its start, without the pages of its queues that were
// never filled.  The daemon's limit with everything is 60 MB.
constexpr std::size_t kMostMemory_bytes = std::size_t{60} << 20;
// The view must follow what arrives within this time.
constexpr Nanoseconds kOldest = 3s;

std::size_t memory_bytes() {
    const auto memory = mallinfo2();
    return memory.uordblks + memory.hblkhd;
}

}  // namespace

/// Checks that each trouble is logged once, and resolved later.
struct Recorder::Sink final : spdlog::sinks::base_sink<std::mutex> {
    explicit Sink(const World& the_world) : world(the_world) {}

    void sink_it_(const spdlog::details::log_msg& message) override {
        const std::string text(message.payload.data(), message.payload.size());
        const Nanoseconds now = world.schedule.now();
        if (world.is_traced)
            std::fprintf(stderr, "%12.6f log: %s\n", std::chrono::duration<double>(now).count(),
                         text.c_str());
        constexpr std::string_view kResolved = "resolved: ";
        constexpr Nanoseconds kOneLook = 10ms;  // Lines of one look at the status.
        if (text.starts_with(kResolved)) {
            const std::string trouble = essence_of(text.substr(kResolved.size()));
            const auto found = troubles.find(trouble);
            if (found == troubles.end()) world.broken("resolved, but never said: " + text);
            troubles.erase(found);
            // A step of the clock replaces the one before.
            const bool is_replaced = trouble.find("clock was set") != std::string::npos;
            if (!is_replaced && now - said_at[trouble] < kOneLook)
                world.broken("said again at each look: " + text);
        } else if (message.level == spdlog::level::warn &&
                   text.find(" more, ") == std::string::npos && !text.ends_with(" times)")) {
            troubles.insert(essence_of(text));
            said_at[essence_of(text)] = now;
        }
    }
    void flush_() override {}

    /// Returns a trouble without numbers and paths, which can change while it lasts.
    static std::string essence_of(const std::string& text) {
        std::istringstream words(text);
        std::string essence;
        for (std::string word; words >> word;)
            if (word.find_first_of("/0123456789") == std::string::npos) essence += word + ' ';
        return essence;
    }

    const World& world;
    std::multiset<std::string> troubles;         ///< Said and not resolved.
    std::map<std::string, Nanoseconds> said_at;  ///< Last time.
};

Recorder::Recorder(World world, int run)
    : world_(std::move(world)),
      random_(world_.seed, "operator " + std::to_string(run)),
      log_(std::make_shared<spdlog::logger>("a351d", std::make_shared<Sink>(world_))),
      status_log_(std::make_unique<daemon::status::StatusLog>(log_)) {
    memory_at_start_ = memory_bytes();
    const wire::DeviceProfile& profile = *wire::find_profile("A351");
    live_ = std::make_unique<daemon::live::Record>(profile, NumberedSamples::kRate_hz,
                                                   daemon::verdict::Options{});
    daemon::store::Options options;
    options.root = world_.root;
    options.station.profile = profile.name;
    options.station.output_rate_hz = NumberedSamples::kRate_hz;
    options.station.filter = "k512_fc9";
    options.reserve_bytes = std::uint64_t{1} << 20;
    options.recovered = [this](const archive::RecoveryReport& report) {
        is_recovered_ = true;
        log_->info("recovered: {} records added, {} there, {} conflicting, {} chunks lost",
                   report.records_added, report.records_confirmed, report.records_conflicting,
                   report.chunks_lost);
    };
    options.sample = [this](const archive::Sample& sample, UtcTime time) { take(sample, time); };
    store_ = std::make_unique<daemon::store::Store>(world_.disk, options, clock_, reads_);

    daemon::source::LinkOptions sensor;
    sensor.address.path = "/dev/simulated";
    sensor.profile = &profile;
    sensor.header.boot_id = clock_.boot_id();
    sensor.header.profile = profile.name;
    sensor.header.output_rate_hz = NumberedSamples::kRate_hz;
    sensor.header.filter = options.station.filter;
    sensor.header.burst_ctrl = sensor.settings.layout.burst_ctrl();
    sensor.header.baud = sensor.baud;
    sensor.known = store_->known_stream();
    sensor.open = [this](const auto&, int baud) { return world_.sensor.open(baud); };
    link_ = std::make_unique<daemon::source::SensorLink>(std::move(sensor), clock_, reads_);
    occupations_ = std::make_unique<daemon::survey::Occupations>(
        *this, std::vector<text::Site>{}, events::read_events(world_.root / "events").events);
}

void Recorder::start() {
    store_->start();
    link_->start();
    watcher_ = std::thread([this] { watch(); });
    operator_ = std::thread([this] { operate(); });
}

bool Recorder::stop() {
    stop_ = true;
    watcher_.join();
    if (operator_.joinable()) operator_.join();
    link_->stop();
    return store_->stop();
}

void Recorder::commit(const events::Event& event) {
    attempted_.push_back(events::to_json(event));
    store_->commit(event);
}

void Recorder::take(const archive::Sample& sample, UtcTime) {
    if (sample.index <= last_index_) {
        ++session_count_;
        unpromised_.clear();
    }
    last_index_ = sample.index;
    unpromised_.push_back({sample.index, sample.values.axes[1]});
    last_taken_ = world_.schedule.now();
}

Status Recorder::status() {
    Status status;
    const timing::ClockReading reading = clock_.read();
    status.now = reading.realtime;
    status.profile = "A351";
    status.output_rate_hz = NumberedSamples::kRate_hz;
    status.verdict = live_->verdict();
    daemon::status::fill(status, link_->status());
    store_->fill(status);
    daemon::status::assess(status);
    return status;
}

void Recorder::watch() {
    while (!stop_) {
        std::this_thread::sleep_for(1s);
        const Status now = status();
        status_log_->note(now, std::chrono::steady_clock::now());
        check_promises(now);
        check_view(now);
        const std::size_t memory = memory_bytes();
        if (memory > memory_at_start_ + kMostMemory_bytes)
            world_.broken(fmt::format("memory grew by {} bytes", memory - memory_at_start_));
    }
}

/// Notes the data that are reported as journaled.  A session is known by the order in which its
/// samples came, so it counts from the second look on.
void Recorder::check_promises(const Status& status) {
    const bool is_same = status.session == watched_session_ && session_count_ == watched_count_;
    watched_session_ = status.session;
    watched_count_ = session_count_;
    if (!is_same || !status.journaled) return;
    for (; !unpromised_.empty() && unpromised_.front().index <= *status.journaled;
         unpromised_.pop_front())
        world_.promises.samples.push_back(unpromised_.front().number);
}

/// The live record must follow what arrives, whatever the disk does.
void Recorder::check_view(const Status& status) {
    const Nanoseconds now = world_.schedule.now();
    // A handshake can fit between two looks.
    const std::uint64_t sessions = status.more_counters.at("link_sessions");
    if (std::exchange(watched_sessions_, sessions) != sessions) sampling_since_.reset();
    if (status.link_state != "sampling" || !is_recovered_) {
        sampling_since_.reset();
        return;
    }
    if (!sampling_since_) sampling_since_ = now;
    const auto arrival = world_.sensor.last_arrival();
    const Nanoseconds from = std::max(*sampling_since_, last_taken_.value_or(Nanoseconds(0)));
    if (arrival && arrival->second > from + kOldest)
        world_.broken(fmt::format("the view is {:.1f} s older than the data",
                                  std::chrono::duration<double>(arrival->second - from).count()));
}

/// An operator who starts, stops and changes stays at random.
void Recorder::operate() {
    while (!stop_) {
        const auto wait = std::chrono::duration<double>(8.0 * random_.exponential());
        for (double waited = 0.0; waited < wait.count() && !stop_; waited += 0.5)
            std::this_thread::sleep_for(500ms);
        if (stop_) return;
        attempted_.clear();
        const auto outcome = act();
        auto& events = world_.promises.events;
        if (outcome.kind == daemon::survey::Outcome::Kind::done)
            events.insert(events.end(), attempted_.begin(), attempted_.end());
    }
}

daemon::survey::Outcome Recorder::act() {
    using daemon::survey::Named;
    const auto list = occupations_->list();
    const Named last = list.empty() ? Named{} : Named{list.back().key, list.back().site};
    switch (random_.bits() % 8) {
        case 0:
        case 1:
        case 2:
            if (occupations_->running()) return occupations_->stop({}, std::nullopt);
            return occupations_->start(fmt::format("No.{}", ++stays_), {}, std::nullopt);
        case 3:
            return occupations_->setup(std::nullopt);
        case 4:
            return occupations_->note({}, fmt::format("note {}", random_.bits() % 1000));
        case 5:
            return occupations_->discard(last, {.reason = "simulated"});
        case 6:
            return occupations_->rename(last, "No.99", {.reason = "simulated"});
        default:
            return occupations_->not_moved(last, {.reason = "simulated"});
    }
}

}  // namespace a351::simulation
