#include "daemon/config/recorded_settings.hpp"

namespace a351::daemon {

record::JournalHeader journal_header(const Config& config, const HostClock& clock) {
    record::JournalHeader header;
    header.boot_id = clock.boot_id();
    header.program_version = A351_VERSION;
    header.codes = config.station.codes;
    header.profile = config.sensor.profile->name;
    header.output_rate_hz = config.sensor.settings.output_rate_hz;
    header.filter = config.sensor.filter;
    header.burst_ctrl = config.sensor.settings.layout.burst_ctrl();
    header.baud = config.sensor.baud;
    header.declared_rate_hz = config.storage.declared_rate_hz;
    if (config.oven) header.oven_interval = archived_interval(*config.oven, clock);
    return header;
}

record::StationDescription station_description(const Config& config) {
    const SensorConfig& sensor = config.sensor;
    record::StationDescription station;
    station.codes = config.station.codes;
    station.latitude = config.station.latitude;
    station.longitude = config.station.longitude;
    station.elevation = config.station.elevation;
    station.profile = sensor.profile->name;
    station.is_profile_verified = sensor.profile->is_verified;
    station.output_rate_hz = sensor.settings.output_rate_hz;
    station.filter = sensor.filter;
    station.group_delay = sensor.profile->group_delay(*sensor.profile->filter_named(sensor.filter));
    station.has_oven = config.oven.has_value();
    return station;
}

}  // namespace a351::daemon
