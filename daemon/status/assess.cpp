#include "daemon/status/assess.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace a351::daemon {
namespace {

// 1 GiB lasts 9 days at 50 Hz: 100 MB of journal and 15 MB of archive a day.
constexpr std::uint64_t kLittleSpace_bytes = std::uint64_t{1} << 30;

/// Replaces unprintable characters: a device may report any bytes as its name.
std::string printable(std::string text) {
    for (char& c : text) {
        if (c < ' ' || c > '~') c = '?';
    }
    return text;
}

/// Adds the oven's reasons.  They contain nothing that varies from poll to poll, because the log
/// distinguishes reasons by their text.
void assess_oven(Status& status, const OvenStatus& oven) {
    if (oven.state == "searching") {
        complain(status, Status::Level::warning, "oven: searching: " + oven.trouble);
    } else if (oven.is_stale) {
        complain(status, Status::Level::warning,
                 "oven: " + (oven.state == "answering" ? "the last answer is old" : oven.state) +
                     "; check the controller's cable (sensor data are not affected)");
    } else if (oven.values && oven::has_input_error(oven.values->status)) {
        complain(
            status, Status::Level::warning,
            "oven: input error, its temperature is not valid; check the controller's probe (sensor "
            "data are not affected)");
    }
}

/// Compares the declared rate with one measured over a day, which includes the temperature's daily
/// course.
void assess_rate(Status& status) {
    constexpr std::chrono::hours kNearlyADay{23};
    // Limit in ppm.  Above it, readers that join records by their rate lose samples in three days.
    constexpr double kTolerable_ppm = 0.2;
    const auto& measured = status.measured_rate;
    if (!measured || measured->span < kNearlyADay || measured->uncertainty_ppm > kTolerable_ppm)
        return;
    char text[160];
    const double rate_hz = measured->rate.value();
    if (!status.declared_rate_hz) {
        std::snprintf(text, sizeof text,
                      "measured over a day: set declared_rate_hz = %.6f in [storage]", rate_hz);
        status.rate_advice = text;
        return;
    }
    const double departure_ppm = 1e6 * (rate_hz / *status.declared_rate_hz - 1.0);
    if (std::abs(departure_ppm) <= kTolerable_ppm + measured->uncertainty_ppm) return;
    std::snprintf(
        text, sizeof text,
        "sample rate: %.6f Hz over a day, %+.2f ppm from declared_rate_hz (limit 0.2 ppm plus its "
        "uncertainty); change it only between deployments",
        rate_hz, departure_ppm);
    status.rate_advice = text;
    complain(status, Status::Level::warning, text);
}

}  // namespace

void complain(Status& status, Status::Level level, std::string reason) {
    status.level = std::max(status.level, level);
    status.reasons.push_back(std::move(reason));
}

void fill(Status& status, const LinkStatus& link) {
    status.link_state = to_text(link.state);
    status.link_trouble = link.trouble;
    status.port = link.port;
    if (link.device) {
        status.product_id = printable(link.device->product_id);
        status.serial_number = printable(link.device->serial_number);
    }
    status.is_device_assumed = link.is_device_assumed;
    status.more_counters["link_sessions"] = link.sessions;
    status.more_counters["link_adoptions"] = link.adoptions;
    status.more_counters["link_stalls"] = link.stalls;
    status.more_counters["ports_lost"] = link.ports_lost;
    status.more_counters["handshake_failures"] = link.handshake_failures;
    status.more_counters["queue_full"] = link.queue_full;
    if (link.waits_for_journal) {
        complain(
            status, Status::Level::warning,
            "the disk is too slow: the buffer is full, reading from the sensor waits and samples "
            "may be lost; check the disk");
    }
    if (link.state != LinkStatus::State::sampling) {
        complain(status, Status::Level::fault, "no data: " + link.trouble);
    } else if (link.device && !link.device->has_expected_product_id) {
        complain(status, Status::Level::warning,
                 "product identifier " + status.product_id +
                     " does not match the profile; check the sensor and sensor.profile");
    }
    if (link.baud != link.configured_baud) {
        complain(status, Status::Level::warning,
                 "the sensor runs at " + std::to_string(link.baud) +
                     " baud, not at the configured " + std::to_string(link.configured_baud) +
                     "; recording continues, set sensor.baud to match");
    }
}

void fill(Status& status, const OvenLinkStatus& link) {
    OvenStatus& oven = status.oven.emplace();
    oven.state = to_text(link.state);
    oven.trouble = link.trouble;
    oven.port = link.port;
    oven.values = link.values;
    oven.decimals = link.decimals;
    oven.age = link.age;
    oven.is_stale = link.is_stale;
    for (std::size_t i = 0; i < link.polls.size(); ++i) {
        oven.polls[to_text(static_cast<record::OvenOutcome>(i))] = link.polls.at(i);
    }
}

void assess(Status& status) {
    assess_rate(status);
    if (status.oven) assess_oven(status, *status.oven);
    const std::string& calibrated = status.calibrated_serial_number;
    if (!calibrated.empty() && !status.serial_number.empty() &&
        calibrated != status.serial_number) {
        complain(status, Status::Level::warning,
                 "the calibration is for unit " + printable(calibrated) +
                     ", but the sensor is unit " + status.serial_number +
                     ": the verdict uses another unit's behaviour; check survey.calibration");
    }
    switch (status.timing_state) {
        case timing::TimingState::unlocked:
            complain(status, Status::Level::warning,
                     "timing: unlocked, sample times are not known until 60 s of data have been "
                     "received; wait");
            break;
        case timing::TimingState::holdover:
            complain(
                status, Status::Level::warning,
                "timing: holdover, the host clock is not synchronised or has jumped; synchronise "
                "it, and correct the times later with a351-correct retime");
            break;
        case timing::TimingState::coarse:
        case timing::TimingState::locked:
            break;
    }
    if (status.counters.records_withheld > 0) {
        complain(status, Status::Level::warning,
                 "the host clock was not set: " + std::to_string(status.counters.records_withheld) +
                     " records are in the journal only; synchronise the clock, then run "
                     "a351-correct retime");
    }
    if (!status.disk_free_bytes) {
        complain(status, Status::Level::warning,
                 "disk: the free space cannot be determined; check the disk of storage.root");
    } else if (*status.disk_free_bytes < kLittleSpace_bytes) {
        complain(status, Status::Level::warning,
                 "disk: less than 1 GiB free, at most 9 days at 50 Hz; make room");
    }
}

}  // namespace a351::daemon
