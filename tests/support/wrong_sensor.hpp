#pragma once
/// @file
/// Sensors whose profile or hardware is wrong, and the troubles that the recorder's watch reports.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/believable/temperature_format.hpp"
#include "protocol/core/units.hpp"
#include "protocol/wire/device_profile.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/signal/sample_source.hpp"

namespace a351::sim {

using daemon::believable::TemperatureFormat;

/// A kind of sensor that does not fit the profile A351.
struct WrongSensor {
    const char* name;
    double within_s;    ///< Time in which the watch must name it.
    const char* words;  ///< Words of its trouble.
    /// Returns the counts that are sent instead of those of the profile.
    /// @param first    the first sample that is wrong
    /// @param since_s  time since then
    signal::SensorSample (*send)(const signal::SensorSample& now, const signal::SensorSample& first,
                                 double since_s);
    /// Format of the temperature with which they are read; null: that of the profile A351.
    const TemperatureFormat* assumed = nullptr;
    /// Format of the temperature in which they are sent; null: that of `assumed`.
    const TemperatureFormat* sent = nullptr;
    bool is_at_next_start = false;  ///< It is found by comparison with the time before the start.
};

[[nodiscard]] std::span<const WrongSensor> wrong_sensors();

/// A simulated record and the sensor in it.
struct WatchedRecord {
    scenario::Scenario scenario;
    std::uint64_t seed = 1;
    double length_s = 0.0;  ///< Length that is played; 0: all.
    /// Set point of the oven from the start of the record on; absent: that of the scenario.
    std::optional<DegC> switched_on_to = {};
    const WrongSensor* wrong = nullptr;  ///< Null: the sensor fits.
    double wrong_from_s = 0.0;           ///< Time since the start from which it is wrong.
    double history_s = 0.0;              ///< Time since the start that is before the run.
    bool is_oven_heard = true;           ///< The oven's controller answers, once a second.
};

struct FirstTroubles {
    double at_s = 0.0;  ///< Time since the sensor is wrong, or since the start.
    std::vector<std::string> texts;
};

/// Plays a record to the watch.
/// @return the first troubles; std::nullopt if there are none
[[nodiscard]] std::optional<FirstTroubles> first_troubles(const WatchedRecord& record);

/// Returns the time after which a wrong sample rate is reported; std::nullopt if it is not reported
/// within ten minutes.  The adapter delivers every 16 ms and stalls for up to 0.4 s every two
/// seconds.
/// @param error  relative error of the rate
[[nodiscard]] std::optional<double> rate_named_after_s(double error, std::uint64_t seed);

}  // namespace a351::sim
