#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/verdict/verdict.hpp"
#include "protocol/archive/archiver.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/oven/controller_values.hpp"
#include "protocol/timing/sample_clock.hpp"

namespace a351::daemon {

/// The oven's controller as last seen.
struct OvenStatus {
    std::string state;  ///< searching, silent, disturbed, answering.
    std::string trouble, port;
    std::optional<oven::ControllerValues> values;  ///< Of the last answer, however old.
    int decimals = 1;                              ///< Of process value and set point.
    std::optional<Nanoseconds> age;                ///< Of the last answer, instrument time.
    bool is_stale = true;                          ///< Older than three polls, or none.
    std::map<std::string, std::uint64_t> polls;    ///< By outcome.
};

/// A snapshot of everything the operator may ask, as `/api/status` publishes it.
struct Status {
    enum class Level { good, warning, fault };

    std::string version;
    Level level = Level::good;
    std::vector<std::string> reasons;  ///< Why the level is not good; empty when it is.

    std::string session;  ///< Hexadecimal; empty before the first.
    UtcTime now;          ///< Instrument time of the snapshot.
    // Index of the last sample of the session that was parsed, that survives a power cut, that is
    // in a synced record.
    std::optional<std::int64_t> received, journaled, archived;
    std::optional<UtcTime> last_sample;

    timing::TimingState timing_state = timing::TimingState::unlocked;
    std::optional<Nanoseconds> timing_uncertainty;       ///< 95 %; absent before the first sample.
    timing::LeapSecond leap = timing::LeapSecond::none;  ///< Announced by the host.
    std::optional<timing::MeasuredRate> measured_rate;
    std::optional<double> declared_rate_hz;  ///< Of the configuration.
    std::string rate_advice;                 ///< What to do about the declared one; or empty.

    std::string port;
    std::string link_state;  ///< searching, handshake, sampling, waiting, stopped.
    std::string link_trouble;
    std::string profile, product_id, serial_number, filter;
    int output_rate_hz = 0;
    bool is_profile_verified = false;
    std::string calibrated_serial_number;  ///< Of the calibration in use; empty: there is none.
    bool is_device_assumed = false;        ///< Its stream was adopted: it could not be asked.

    std::array<StandardGravity, 3> acceleration{};
    DegC temperature;
    Verdict verdict;
    std::optional<OvenStatus> oven;  ///< Absent: not enabled.

    record::ArchiverCounters counters;
    std::map<std::string, std::uint64_t> more_counters;  ///< Of link and store, by name.

    std::optional<std::uint64_t> disk_free_bytes;  ///< Absent: it cannot be told.
    std::string disk_reserve;                      ///< present, given_up, unavailable.
    std::string disk_reserve_trouble;              ///< Why it is unavailable.
    std::chrono::milliseconds longest_sync{0};     ///< Of the journal, or write.
};

}  // namespace a351::daemon
