#pragma once

#include "daemon/config/config.hpp"
#include "daemon/live/live_record.hpp"
#include "daemon/source/host_clock.hpp"
#include "daemon/source/ovens.hpp"
#include "daemon/source/sensor_link.hpp"
#include "daemon/status/status.hpp"
#include "daemon/store/store.hpp"

namespace a351::daemon::recorder {

/// The parts of the recorder whose state the status shows.
struct Parts {
    const config::Config& config;
    const source::HostClock& clock;
    const source::SensorLink& link;
    const source::Ovens& ovens;
    store::Store& store;
    live::Record& live;
};

/// Returns the status as it is now, with its level and reasons.
[[nodiscard]] status::Status snapshot(const Parts& parts);

}  // namespace a351::daemon::recorder
