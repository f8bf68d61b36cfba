#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/source/battery.hpp"
#include "daemon/source/oven_link.hpp"
#include "daemon/source/sensor_link.hpp"
#include "daemon/verdict/verdict.hpp"
#include "protocol/archive/archiver.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/text/message.hpp"
#include "protocol/timing/sample_clock.hpp"

namespace a351::daemon::status {

/// A step of the host's clock that the sample times followed.
struct ClockStep {
    UtcTime before;  ///< Time of the step by the old clock.
    UtcTime after;   ///< The same by the new clock.
};

/// Another sensor, which records since then.
struct UnitChange {
    UtcTime since;
    std::string before, after;  ///< Serial numbers.
};

/// A snapshot of the daemon's state as `/api/status` publishes it.
struct Status {
    enum class Level { good, warning, fault };

    /// Adds a reason and raises the level to at least `least`.
    void complain(Level least, text::Message reason) {
        level = std::max(level, least);
        reasons.push_back(std::move(reason));
    }
    void warn(text::Message reason) { complain(Level::warning, std::move(reason)); }
    void fail(text::Message reason) { complain(Level::fault, std::move(reason)); }

    std::string version;
    Level level = Level::good;
    std::vector<text::Message> reasons;  ///< Reasons why the level is not good; empty if it is.

    std::string session;          ///< Hexadecimal; empty before the first session.
    UtcTime now;                  ///< Instrument time of the snapshot.
    UtcTime host_now;             ///< The same by the clock of the host.
    bool is_in_real_time = true;  ///< False if instrument time is faster or slower than the host's.
    // Index of the last sample of the session that was parsed (received), survives a power cut
    // (journaled), is in a synced record (archived).
    std::optional<std::int64_t> received, journaled, archived;
    std::optional<UtcTime> last_sample;

    timing::State timing_state = timing::State::unlocked;
    std::optional<Nanoseconds> timing_uncertainty;  ///< 95 %; absent before the first sample.
    std::optional<Nanoseconds> host_uncertainty;    ///< Its part that is the host's clock.
    bool is_host_synchronised = false;
    timing::LeapSecond leap = timing::LeapSecond::none;  ///< Leap second announced by the host.
    std::optional<ClockStep> clock_step;                 ///< Newest one of this run.
    std::optional<timing::MeasuredRate> measured_rate;
    std::optional<Hertz> wrong_rate;         ///< See believable::RateWatch.
    std::optional<double> declared_rate_hz;  ///< Rate set in the configuration.
    text::Message rate_advice;               ///< Advice on setting declared_rate_hz; empty if none.

    std::string port;
    std::string link_state;  ///< searching, handshake, sampling, waiting, stopped.
    std::string link_trouble;
    std::string profile, product_id, serial_number, filter;
    int output_rate_hz = 0;
    bool is_profile_verified = false;
    std::string calibrated_serial_number;   ///< Unit of the calibration in use; empty if none.
    std::optional<UnitChange> unit_change;  ///< Newest one within a survey day.
    /// When the sampling of a sensor that had stopped was started again, in this run.
    std::optional<UtcTime> started_again;
    std::string start_up_test;  ///< Result of the sensor's last start-up test, as in the journal.
    bool is_device_assumed = false;  ///< The stream was adopted; the device was not asked.

    std::array<StandardGravity, 3> acceleration{};
    DegC temperature;
    verdict::Verdict verdict;
    std::vector<text::Message> sensor_troubles;        ///< See live::Record::troubles().
    std::optional<source::OvenLinkStatus> oven;        ///< Absent if not enabled.
    std::optional<source::OvenLinkStatus> outer_oven;  ///< Absent if not enabled.

    archive::Counters counters;
    std::map<std::string, std::uint64_t> more_counters;  ///< Counters of link and store, by name.

    std::optional<std::uint64_t> disk_free_bytes;     ///< Absent if it cannot be determined.
    std::string disk_reserve;                         ///< present, given_up, unavailable.
    std::string disk_reserve_trouble;                 ///< Reason why it is unavailable.
    std::chrono::milliseconds longest_sync{0};        ///< Longest sync or write of the journal.
    files::DiskWork disk_work;                        ///< Since the start.
    std::optional<files::DiskWork> hourly_disk_work;  ///< An hour; absent in the first minute.
    std::optional<source::Battery> battery;           ///< Absent if the computer has none.
};

/// Returns the state in one short line, for the service manager: the link's and the first reason.
[[nodiscard]] std::string brief(const Status& status);

/// Copies the state of the sensor's link into the status, and adds its reasons.
void fill(Status& status, const source::LinkStatus& link);

/// Returns the sentence about another sensor that was attached within the last hour.
[[nodiscard]] std::optional<text::Message> unit_warning(const Status& status);

/// Adds the level and reasons of a completely filled status: values of the sensor, sample rate, oven,
/// calibration, sample times and battery.
void assess(Status& status);

}  // namespace a351::daemon::status
