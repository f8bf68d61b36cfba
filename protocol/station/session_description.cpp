#include "protocol/station/session_description.hpp"

#include <stdexcept>

#include "protocol/wire/device_profile.hpp"

namespace a351::station {

void describe_session(Description& description, const journal::Header& header) {
    const wire::DeviceProfile* const profile = wire::find_profile(header.profile);
    if (profile == nullptr)
        throw std::invalid_argument("unknown device profile '" + header.profile + "'");
    description.codes = header.codes;
    description.profile = header.profile;
    description.is_profile_verified = profile->is_verified;
    description.product_id = header.product_id;
    description.serial_number = header.serial_number;
    description.firmware = header.firmware;
    description.start_up_test = header.start_up_test;
    description.output_rate_hz = header.output_rate_hz;
    description.filter = header.filter;
    if (const auto* const filter = profile->filter_named(header.filter))
        description.group_delay = profile->group_delay(*filter);
    description.declared_rate_hz = header.declared_rate_hz;
    description.oven_interval = header.oven_interval;
    description.outer_oven_interval = header.outer_oven_interval;
    // The times of the first samples precede their header by the filter's delay.
    description.start = header.clock.realtime - description.group_delay;
}

}  // namespace a351::station
