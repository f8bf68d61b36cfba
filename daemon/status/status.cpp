#include "daemon/status/status.hpp"

#include <fmt/core.h>

#include <cmath>

#include "daemon/believable/rate_watch.hpp"
#include "protocol/oven/controller_values.hpp"

namespace a351::daemon::status {
namespace {

/// Replaces unprintable characters: a device may report any bytes as its name.
std::string printable(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

/// Adds an oven's reasons.  They contain nothing that varies from poll to poll, because the log
/// distinguishes reasons by their text.
/// @param name  of the oven, a text of the catalogue.
void assess_oven(Status& status, const char* name, const source::OvenLinkStatus& oven) {
    using State = source::OvenLinkStatus::State;
    const text::Message which = text::marked_message(name);
    if (oven.state == State::searching) {
        status.warn(text::message("{}: searching: {}", which, oven.trouble));
    } else if (oven.is_stale) {
        status.warn(text::message(
            "{}: {}; check the controller's cable (sensor data are not affected)", which,
            oven.state == State::answering ? text::message("the last answer is old")
                                           : text::marked_message(source::to_text(oven.state))));
    } else if (oven.values && oven::has_input_error(oven.values->status)) {
        status.warn(text::message(
            "{}: input error, its temperature is not valid; check the controller's probe (sensor "
            "data are not affected)",
            which));
    }
}

/// Reports a sample rate that is far from the configured one.  Compares the declared rate with a
/// rate measured over a day, so that the daily course of the temperature is included.
void assess_rate(Status& status) {
    // An emulator that is faster than real time may lag behind its clock.
    if (status.wrong_rate && status.is_in_real_time)
        status.fail(believable::rate_trouble(*status.wrong_rate, status.output_rate_hz));
    constexpr std::chrono::hours kNearlyADay{23};
    // Limit in ppm.  Above it, readers that join records by their rate lose samples in three days.
    constexpr double kTolerable_ppm = 0.2;
    const auto& measured = status.measured_rate;
    if (!measured || measured->span < kNearlyADay || measured->uncertainty_ppm > kTolerable_ppm)
        return;
    const double rate_hz = measured->rate.value();
    if (!status.declared_rate_hz) {
        status.rate_advice = text::message(
            "measured over a day: set declared_rate_hz = {:.6f} in [storage]", rate_hz);
        return;
    }
    const double departure_ppm = 1e6 * (rate_hz / *status.declared_rate_hz - 1.0);
    if (std::abs(departure_ppm) <= kTolerable_ppm + measured->uncertainty_ppm) return;
    status.rate_advice = text::message(
        "sample rate: {:.6f} Hz over a day, {:+.2f} ppm from declared_rate_hz (limit {} ppm plus "
        "its uncertainty); change it only between deployments",
        rate_hz, departure_ppm, kTolerable_ppm);
    // Without the rate, which varies: the log would say it again each second.
    status.warn(text::message(
        "the sample rate differs from declared_rate_hz by more than {} ppm plus its uncertainty; "
        "the measured rate is in the row rate; change declared_rate_hz only between deployments",
        kTolerable_ppm));
}

/// Returns the sentence about a step of the host's clock, which is complete without the log.
text::Message sentence_of(const ClockStep& step) {
    const double by_s = seconds_between(step.before, step.after);
    const std::string before = to_rfc3339(step.before, 1), after = to_rfc3339(step.after, 1);
    const text::Message change = text::message(
        "the laptop's clock was set {} by {:.1f} s, from {} to {}",
        by_s > 0.0 ? text::message("ahead") : text::message("back"), std::abs(by_s), before, after);
    if (by_s > 0.0)
        return change +
               text::message("; the sample times followed: no sample has a time in between");
    return text::message("{}; the sample times followed: the times from {} to {} occur twice",
                         change, after, before);
}

/// Returns true for an hour after this time, unless the clock was set back since then.
bool is_shown(UtcTime time, UtcTime now) {
    return time <= now && now < time + std::chrono::hours(1);
}

/// Adds the reason if the sensor had stopped, and was started again.  It does not contain the time: a
/// loose plug stops a sensor again and again.
void assess_power(Status& status) {
    if (!status.started_again || !is_shown(*status.started_again, status.now)) return;
    status.warn(text::message(
        "the sensor had stopped within the last hour, and was started again: it was switched off, "
        "or its line was disturbed; if it was off, it warms up again; check its plug and its "
        "power supply"));
}

/// Adds the reasons that concern the host's clock.  The sample times follow it, so samples are later
/// only if more of them come per second than the sensor's rate, or if the clock was set back.
void assess_clock(Status& status) {
    // A delay of 16 ms is 16 s of simulated time at 1000x, and says nothing about the host's clock.
    if (!status.is_in_real_time) return;
    const auto& step = status.clock_step;
    // A clock that was right when it was set back is synchronised.
    const bool is_behind = step && status.now < step->before && !status.is_host_synchronised;
    if (is_behind) {
        status.warn(sentence_of(*step) +
                    text::message("; it is behind the recorded data: set it (timedatectl), and "
                                  "correct the times later with a351-correct retime"));
    } else if (step && is_shown(step->after, status.now)) {
        status.warn(sentence_of(*step) +
                    text::message(
                        "; if it was wrong to set it, correct the times with a351-correct retime"));
    }
    constexpr std::chrono::seconds kAhead{5};     // above the uncertainty of a locked clock
    constexpr std::chrono::seconds kUnknown{15};  // the kernel's bound of a clock never set is 16 s
    if (!is_behind && status.last_sample && *status.last_sample > status.now + kAhead) {
        status.warn(text::message(
            "the samples are later than the clock: an emulator or a replay is faster than real "
            "time, or the clock was set back; start a351d with the emulator's --clock, or see "
            "sim/relive"));
    }
    if (!status.is_host_synchronised && status.timing_uncertainty &&
        *status.timing_uncertainty > kUnknown) {
        // Without the number, which grows: the log would say it again each second.
        status.warn(
            text::message("the laptop's clock was never synchronised: times may be wrong by many "
                          "seconds; synchronise it (timedatectl), and correct the times later with "
                          "a351-correct retime"));
    }
}

/// Adds the reason if the sensor has not passed its last start-up test.  Reading DIAG_STAT clears the
/// error in the sensor; here it remains until a later test is passed.
void assess_start_up_test(Status& status, wire::StartUpTest result) {
    if (result == wire::StartUpTest::passed) return;
    if (result == wire::StartUpTest::unknown)
        return status.warn(text::message(
            "it is not known whether the sensor passed its start-up test: the answer was lost; "
            "check the sensor's cable, then switch the sensor off and on"));
    const text::Message meaning = result == wire::StartUpTest::flash_error
                                      ? text::message("it may lack its calibration")
                                      : text::message("it is faulty");
    status.fail(text::message(
        "the sensor failed its start-up test ({}): {}; recording continues, but do not trust the "
        "readings; switch the sensor off and on, and if this remains, use another sensor",
        std::string(wire::to_text(result)), meaning));
}

/// Adds the reason if the battery is nearly empty.  It does not contain the charge, which varies.
void assess_battery(Status& status) {
    constexpr double kNearlyEmpty_percent = 15.0;
    if (!status.battery || !status.battery->is_discharging ||
        status.battery->percent > kNearlyEmpty_percent)
        return;
    status.warn(
        text::message("the laptop's battery has {:.0f} % or less: connect its power supply; "
                      "recording ends when the battery is empty",
                      kNearlyEmpty_percent));
}

}  // namespace

std::optional<text::Message> unit_warning(const Status& status) {
    const auto& change = status.unit_change;
    if (!change || !is_shown(change->since, status.now)) return std::nullopt;
    return text::message(
        "another sensor records since {}: {} after {}; a stay that was running has ended; the "
        "correction gives each sensor its own constant; if nobody exchanged it, check which box is connected",
        to_rfc3339(change->since, 0), printable(change->after), printable(change->before));
}

std::string brief(const Status& status) {
    return status.reasons.empty() ? status.link_state
                                  : status.link_state + "; " + status.reasons.front().english();
}

void fill(Status& status, const source::LinkStatus& link) {
    status.link_state = source::to_text(link.state);
    status.link_trouble = link.trouble;
    status.port = link.port;
    if (link.device) {
        status.product_id = printable(link.device->product_id);
        status.serial_number = printable(link.device->serial_number);
    }
    status.is_device_assumed = link.is_device_assumed;
    status.more_counters.insert({{"link_sessions", link.sessions},
                                 {"link_adoptions", link.adoptions},
                                 {"link_stalls", link.stalls},
                                 {"ports_lost", link.ports_lost},
                                 {"handshake_failures", link.handshake_failures},
                                 {"queue_full", link.queue_full}});
    if (link.waits_for_journal) {
        status.warn(text::message(
            "the disk is too slow: the buffer is full, reading from the sensor waits and samples "
            "may be lost; check the disk"));
    }
    if (link.state != source::LinkStatus::State::sampling) {
        status.fail(text::message("no data: {}", link.trouble));
    } else if (link.device && !link.device->has_expected_product_id) {
        status.warn(text::message(
            "product identifier {} does not match the profile; check the sensor and sensor.profile",
            status.product_id));
    }
    status.start_up_test = wire::to_text(link.start_up_test);
    assess_start_up_test(status, link.start_up_test);
    const bool is_sampling = link.state == source::LinkStatus::State::sampling;
    if (is_sampling && link.baud != link.configured_baud) {
        status.warn(
            text::message("the sensor runs at {} baud, not at the configured {}; recording "
                          "continues, set sensor.baud to match",
                          link.baud, link.configured_baud));
    }
}

void assess(Status& status) {
    for (const text::Message& trouble : status.sensor_troubles) status.fail(trouble);
    assess_rate(status);
    if (status.oven) assess_oven(status, text::marked("oven"), *status.oven);
    if (status.outer_oven) assess_oven(status, text::marked("outer oven"), *status.outer_oven);
    const std::string& calibrated = status.calibrated_serial_number;
    if (!calibrated.empty() && !status.serial_number.empty() &&
        calibrated != status.serial_number) {
        status.warn(
            text::message("the calibration is for unit {}, but the sensor is unit {}: the signal "
                          "uses another unit's behaviour; check survey.calibration",
                          printable(calibrated), status.serial_number));
    }
    if (const auto warning = unit_warning(status)) status.warn(*warning);
    assess_power(status);
    assess_clock(status);
    if (status.timing_state == timing::State::unlocked) {
        status.warn(text::message(
            "timing: unlocked, sample times are not known until 60 s of data have been received; "
            "wait"));
    } else if (status.timing_state == timing::State::holdover) {
        status.warn(text::message(
            "timing: holdover, the host clock lost its synchronisation or jumped; synchronise it, "
            "and correct the times later with a351-correct retime"));
    }
    if (status.counters.records_withheld > 0) {
        status.warn(
            text::message("the host clock was not set: some records are in the journal only; "
                          "synchronise the clock, then run a351-correct retime"));
    }
    assess_battery(status);
}

}  // namespace a351::daemon::status
