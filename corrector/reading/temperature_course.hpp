#pragma once
/// @file
/// The temperature of a survey in means of one minute.

#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::corrector {

/// The mean temperature of one minute.
struct MinuteTemperature {
    UtcTime middle;  ///< Middle of a minute of UTC.
    DegC mean;       ///< Mean of its samples.
};

/// Returns the sensor's temperature in means of one minute, in order of time; minutes without a
/// sample are left out.
/// @param segments  counts of the temperature channel, with time stamps.
/// @param scale     degC = offset + gain x count.
[[nodiscard]] std::vector<MinuteTemperature> temperature_course(
    const std::vector<record::Segment>& segments, const record::ChannelScale& scale);

}  // namespace a351::corrector
