#pragma once
/// @file
/// One run of the recording part of the daemon, wired as in daemon/main.cpp, with an operator.

#include <spdlog/logger.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/live/live_record.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/source/sensor_link.hpp"
#include "daemon/status/status.hpp"
#include "daemon/status/status_log.hpp"
#include "daemon/store/store.hpp"
#include "daemon/survey/occupations.hpp"
#include "tests/simulation/simulated_disk.hpp"
#include "tests/simulation/simulated_sensor.hpp"

namespace a351::simulation {

/// Promises of all runs together: it must be on disk later.
struct Promises {
    std::vector<std::int64_t> samples;  ///< Numbers of samples that were said to be journaled.
    std::vector<std::string> events;    ///< Events that were accepted.
};

/// The world around a recorder.
struct World {
    std::uint64_t seed;
    Schedule& schedule;
    Host& host;
    SimulatedDisk& disk;
    SimulatedSensor& sensor;
    std::filesystem::path root;
    Promises& promises;
    /// Ends the simulation: an invariant is broken.
    std::function<void(const std::string&)> broken;
    bool is_traced = false;
};

class Recorder final : public daemon::survey::Recorder {
public:
    /// @throws what the daemon's parts throw when they cannot start.
    explicit Recorder(World world, int run);

    void start();
    /// Ends it as SIGTERM does.  @return false if something could not be written.
    bool stop();

    [[nodiscard]] bool is_recovered() const noexcept { return is_recovered_; }
    [[nodiscard]] daemon::status::Status status();

private:
    struct Sink;
    struct Numbered {
        std::int64_t index = 0, number = 0;
    };

    // The daemon::survey::Recorder of the operator, which notes what was accepted.
    std::optional<daemon::survey::Instant> latest() override { return store_->latest(); }
    std::optional<daemon::survey::Instant> at(UtcTime utc) override { return store_->at(utc); }
    Nanoseconds signal_since(const journal::SessionId& session, std::int64_t index) override {
        return store_->signal_since(session, index);
    }
    void commit(const events::Event& event) override;
    void note(const events::Event& event) override { store_->note(event); }

    void take(const archive::Sample& sample, UtcTime time);
    void watch();
    void check_promises(const daemon::status::Status& status);
    void check_view(const daemon::status::Status& status);
    void operate();
    daemon::survey::Outcome act();

    World world_;
    sim::noise::RandomStream random_;
    daemon::source::HostClock clock_;
    std::shared_ptr<spdlog::logger> log_;
    daemon::source::ReadQueue reads_;
    std::unique_ptr<daemon::live::Record> live_;
    std::unique_ptr<daemon::store::Store> store_;
    std::unique_ptr<daemon::source::SensorLink> link_;
    std::unique_ptr<daemon::survey::Occupations> occupations_;
    std::unique_ptr<daemon::status::StatusLog> status_log_;
    std::atomic<bool> is_recovered_{false}, stop_{false};
    std::thread watcher_, operator_;

    // The order of the sessions, and the samples of the present one.
    int session_count_ = 0;
    std::int64_t last_index_ = -1;
    std::deque<Numbered> unpromised_;
    std::string watched_session_;  ///< Session of the last look, and their number then.
    int watched_count_ = 0;
    std::vector<std::string> attempted_;  ///< Events of the operator's present action.
    int stays_ = 0;
    std::optional<Nanoseconds> sampling_since_, last_taken_;
    std::uint64_t watched_sessions_ = 0;  ///< Sessions of the link at the last look.
    std::size_t memory_at_start_ = 0;
};

}  // namespace a351::simulation
