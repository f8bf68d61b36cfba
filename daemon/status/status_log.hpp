#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "daemon/status/status.hpp"

namespace spdlog {
class logger;
}

namespace a351::daemon::status {

/// Turns successive snapshots into log lines: changes of state, and each trouble when it begins,
/// once a minute with its count, and when it ends.
class StatusLog {
public:
    using Instant = std::chrono::steady_clock::time_point;

    explicit StatusLog(std::shared_ptr<spdlog::logger> log) : log_(std::move(log)) {}

    void note(const Status& status, Instant now);

private:
    struct Trouble {
        Instant said;
        std::uint64_t times = 0;  ///< Number of snapshots that showed it.
        std::string reason;       ///< Its text in the newest one.
    };
    void note_reasons(const Status& status, Instant now);
    void note_counter(const std::string& name, std::uint64_t value, Instant now);
    void note_oven(const std::string& name, const std::optional<source::OvenLinkStatus>& oven,
                   Instant now);

    struct Counter {
        std::uint64_t said_value = 0;
        Instant said;
    };

    std::shared_ptr<spdlog::logger> log_;
    std::string session_;
    std::string link_state_;
    std::map<std::string, std::string> oven_states_;
    std::string reserve_;
    std::string rate_advice_;
    timing::LeapSecond leap_ = timing::LeapSecond::none;
    std::map<std::string, Trouble> troubles_;
    std::map<std::string, Counter> counters_;
};

}  // namespace a351::daemon::status
