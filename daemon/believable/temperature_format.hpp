#pragma once
/// @file
/// Formats in which sensors of this generation send their temperature.  No public document names
/// that of the M-A351, so the right one is found by exclusion: for the watch of a stream, and for
/// `--identify`.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::believable {

/// Counts of the temperature in some seconds, as received.
struct TemperatureCounts {
    std::int32_t least = 0, most = 0;
    double mean = 0.0;

    /// Returns true if all are 0 or all are -1, as those of a register without a value.
    [[nodiscard]] bool are_empty() const noexcept {
        return least == most && (least == 0 || least == -1);
    }
};

/// A format: degC = slope_degc x counts + offset_degc.
struct TemperatureFormat {
    const char* formula;  ///< With N for the counts; empty for that of a profile.
    double slope_degc;
    double offset_degc;

    [[nodiscard]] DegC temperature(const TemperatureCounts& counts) const noexcept {
        return DegC(slope_degc * counts.mean + offset_degc);
    }
    /// Returns true if a sensor with this format can send these counts:
    ///
    ///   - the mean is believable (limits.hpp);
    ///   - not all counts are smaller than a step of the thermometer.  Counts of a 65536th of a step
    ///     change in steps of 65536; smaller ones would read as the offset, whatever they are;
    ///   - they are not empty.
    [[nodiscard]] bool is_possible(const TemperatureCounts& counts) const noexcept;
};

/// Returns the formats of the family.
[[nodiscard]] std::span<const TemperatureFormat> temperature_formats() noexcept;

/// Returns the format of a profile.
[[nodiscard]] TemperatureFormat format_of(const wire::DeviceProfile& profile) noexcept;

/// A format that counts fit.
struct TemperatureFit {
    TemperatureFormat format;
    DegC temperature;  ///< Mean of the counts in this format.
    bool is_of_profile = false;
};

/// Returns the formats that counts fit, of that of the profile and those of the family, the most likely
/// one first:
///
///   - If the oven's temperature is known, the one that is within kMostFromOven_degc of it, alone.
///   - Otherwise, or if none is, first that of the profile if it gives a usual temperature (limits.hpp).
///   - Otherwise in the order of the distance from 30 degC, as a room, a box or an oven has.
///
/// Each is possible.  No counts have a usual temperature in two formats of the family.
/// @param own  format of the profile
[[nodiscard]] std::vector<TemperatureFit> fitting_formats(const TemperatureCounts& counts,
                                                          const TemperatureFormat& own,
                                                          std::optional<DegC> oven = {});

}  // namespace a351::daemon::believable
