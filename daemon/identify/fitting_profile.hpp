#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::identify {

/// Values of a profile to change so that it fits a sensor.
struct Changes {
    std::string product_id = {};  ///< Eight letters or digits; empty: the profile has it.
    std::optional<int> acceleration_fraction_bits = {};
    struct Temperature {
        double slope_degc = 0.0, offset_degc = 0.0;
    };
    std::optional<Temperature> temperature = {};

    [[nodiscard]] bool is_empty() const {
        return product_id.empty() && !acceleration_fraction_bits && !temperature;
    }
};

/// Returns the shipped profile of a product, or null.
[[nodiscard]] const wire::DeviceProfile* shipped_profile_of(const std::string& product_id);

/// Returns where the values of a profile are from, as its file says: "acceleration: ...", one for each
/// table, after that of the device.
[[nodiscard]] std::vector<std::string> sources_of(const wire::DeviceProfile& profile);

/// Returns the text of a profile file: that of `base` with changes, which are marked as assumed.
/// @return std::nullopt if the file of `base` is written so that the lines to change are not found.
[[nodiscard]] std::optional<std::string> fitting_profile(const wire::DeviceProfile& base,
                                                         const Changes& changes);

}  // namespace a351::daemon::identify
