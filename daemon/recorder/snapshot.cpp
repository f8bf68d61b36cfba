#include "daemon/recorder/snapshot.hpp"

#include <chrono>

namespace a351::daemon::recorder {

status::Status snapshot(const Parts& parts) {
    const auto& [config, clock, link, ovens, store, live] = parts;
    status::Status status;
    status.version = A351_VERSION;
    const timing::ClockReading reading = clock.read();
    status.now = reading.realtime;
    status.host_now = source::host_realtime();
    constexpr std::chrono::seconds kSecond{1};
    status.is_in_real_time = clock.instrument_span(kSecond) == kSecond;
    status.leap = reading.leap;
    status.verdict = live.verdict();
    status.sensor_troubles = live.troubles();
    status.profile = config.station.profile;
    status.is_profile_verified = config.station.is_profile_verified;
    status.filter = config.station.filter;
    status.output_rate_hz = config.station.output_rate_hz;
    status.declared_rate_hz = config.storage.declared_rate_hz;
    if (const auto& unit = config.survey.calibration)
        status.calibrated_serial_number = unit->serial_number;
    status::fill(status, link.status());
    if (ovens.inner) status.oven = ovens.inner->status();
    if (ovens.outer) status.outer_oven = ovens.outer->status();
    status.battery = source::read_battery();
    store.fill(status);
    status::assess(status);
    return status;
}

}  // namespace a351::daemon::recorder
