#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include "tests/support/catch.hpp"

#include "daemon/page/api.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"
#include "tests/unit/daemon/page_token.hpp"

namespace a351::daemon {

using nlohmann::json;

inline page::Request get(const std::string& target) {
    return {"GET", target, {{"Host", "127.0.0.1:8351"}}, "", "127.0.0.1:8351", true};
}

inline page::Request post(const std::string& target, const std::string& body = "{}") {
    return {"POST",
            target,
            {{"Host", "127.0.0.1:8351"},
             {"Content-Type", "application/json"},
             {"X-A351-Token", kToken}},
            body};
}

inline page::Request with(page::Request request, const std::string& name,
                          const std::string& value) {
    std::erase_if(request.headers, [&](const auto& header) { return header.first == name; });
    request.headers.emplace_back(name, value);
    return request;
}

inline page::Request without(page::Request request, const std::string& name) {
    std::erase_if(request.headers, [&](const auto& header) { return header.first == name; });
    return request;
}

/// Returns true if the member at `pointer` is written as `expected`.  json's own comparison is not
/// used, because each use within CHECK costs the compiler a second.
inline bool is(const json& whole, const std::string& pointer, const std::string& expected) {
    const auto found = whole.at(json::json_pointer(pointer)).dump();
    UNSCOPED_INFO(pointer << " is " << found << ", not " << expected);
    return found == expected;
}

/// Fills a status at the end of the recorder's hour with all values that a recorder can have.
inline void fill(status::Status& status) {
    status.version = "1.2";
    status.last_sample = minute(60);
    status.now = minute(60) + std::chrono::milliseconds(500);
    status.received = 1000;
    status.journaled = 990;
    status.archived = 900;
    status.output_rate_hz = 50;
    status.timing_uncertainty = std::chrono::microseconds(1500);
    status.host_uncertainty = std::chrono::microseconds(400);
    status.measured_rate = {Hertz(50.0005), 0.03, std::chrono::hours(24)};
    status.acceleration = {StandardGravity(0.0015), StandardGravity(-0.00225),
                           StandardGravity(0.9993)};
    status.temperature = DegC(31.25);
    status.oven = source::OvenLinkStatus{
        .state = source::OvenLinkStatus::State::answering,
        .trouble = "",
        .port = "/dev/pts/5",
        .values = oven::ControllerValues{DegC(42.5), DegC(43.0), Percent(25.0), 0x0100},
        .decimals = 1,
        .age = std::chrono::milliseconds(400),
        .is_stale = false,
        .polls = {7, 0, 2}};
    status.outer_oven = status.oven;
    status.counters.checksum_errors = 2;
    status.counters.frames = 1000;
    status.more_counters["archive_records_waiting"] = 5;
    status.disk_free_bytes = 5'500'000'000;
    status.disk_reserve = "given_up";
    status.longest_sync = std::chrono::milliseconds(250);
    status.disk_work = {8192, 3};
    status.hourly_disk_work = {27'340'000, 4980};
    status.battery = {.percent = 79.6, .is_discharging = true};
}

/// The HTTP interface of a recorder that has one hour of samples.
struct Page {
    FakeRecorder recorder;
    survey::Occupations occupations{recorder, two_sites(), {}};
    live::Record live{*wire::find_profile("A351"), 50, {}};
    status::Status status;
    std::string gravity_so_far = R"({"reason":"not_yet","stays":[]})";
    survey::SoFarReader reader{{}, [this](const auto& event) { recorder.note(event); }};
    int changes = 0;  ///< Times that the API said that something changed.
    page::Api api{{.status = [this] { return status; },
                   .occupations = occupations,
                   .live = live,
                   .events = [this] { return recorder.log; },
                   .gravity_so_far = [this] { return gravity_so_far; },
                   .so_far = [this] { return reader.read(gravity_so_far); },
                   .changed = [this] { ++changes; }},
                  kToken};

    json ask(const page::Request& request, int expected = 200) {
        const auto response = api.answer(request);
        CAPTURE(request.target, request.body, response.body);
        CHECK(response.status == expected);
        auto body = json::parse(response.body);
        CHECK(body.contains("error") == (expected != 200));
        return body;
    }
};

}  // namespace a351::daemon
