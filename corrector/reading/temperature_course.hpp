#pragma once

#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::corrector {

struct MinuteTemperature {
    UtcTime middle;  ///< Of a minute of UTC.
    DegC mean;       ///< Of its samples.
};

/// The sensor's temperature in means of one minute; minutes without a sample are left out.
[[nodiscard]] std::vector<MinuteTemperature> temperature_course(
    const std::vector<record::Segment>& segments, const record::ChannelScale& scale);

}  // namespace a351::corrector
