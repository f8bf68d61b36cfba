#pragma once

#include <cerrno>
#include <chrono>
#include <optional>
#include <system_error>
#include <vector>

#include "daemon/survey/recorder.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon {

inline const UtcTime kMorning = *parse_rfc3339("2026-03-14T08:00:00Z");

inline UtcTime minute(int minutes) { return kMorning + std::chrono::minutes(minutes); }

/// A recorder with one sample per second, from minute 0 to `last`, with times by a clock that was set
/// back by `set_back`.
class FakeRecorder : public survey::Recorder {
public:
    std::optional<survey::Instant> latest() override {
        return last ? at(*last - set_back) : std::nullopt;
    }
    std::optional<survey::Instant> at(UtcTime utc) override {
        utc += set_back;
        if (!last || utc < kMorning || utc > *last) return std::nullopt;
        const auto seconds = std::chrono::ceil<std::chrono::seconds>(utc - kMorning);
        return survey::Instant{session, seconds.count(), kMorning + seconds - set_back};
    }
    Nanoseconds signal_since(const journal::SessionId&, std::int64_t index) override {
        return std::chrono::seconds(latest()->index - index);
    }
    void commit(const events::Event& event) override {
        if (is_disk_full) throw std::system_error(ENOSPC, std::generic_category(), "events");
        log.push_back(event);
    }
    void note(const events::Event& event) override { log.push_back(event); }

    journal::SessionId session{{1, 2, 3}};
    std::optional<UtcTime> last = minute(60);
    Nanoseconds set_back{0};
    bool is_disk_full = false;
    std::vector<events::Event> log;
};

inline std::vector<text::Site> two_sites() {
    std::vector<text::Site> list(2);
    list[0].name = "No.0";
    list[0].gravity = MilliGal(979948.0);
    list[1].name = "No.1";
    return list;
}

}  // namespace a351::daemon
