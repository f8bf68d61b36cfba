#pragma once
/// @file
/// Formats in which sensors of this generation send their temperature.  No public document names
/// that of the M-A351, so the right one is found by exclusion.

#include <cstdint>
#include <span>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon::believable {

/// A format: degC = slope_degc x counts + offset_degc.
struct TemperatureFormat {
    const char* name;
    double slope_degc;
    double offset_degc;

    /// Returns true if the profile converts with this format; the width of the counter is ignored.
    [[nodiscard]] bool is_that_of(const wire::DeviceProfile& profile) const noexcept;
};

/// Returns all formats.
[[nodiscard]] std::span<const TemperatureFormat> temperature_formats() noexcept;

/// The temperature that counts mean in a format.
struct TemperatureCandidate {
    const TemperatureFormat* format;
    DegC temperature;  ///< Mean.
    bool is_possible = false;
};

/// Converts counts of at least some seconds in each format.  A format is possible if
///
///   - the mean is believable (limits.hpp);
///   - not all counts are smaller than its step.  The format with counts of 1/65536 changes in steps
///     of 65536: smaller counts are those of another format, and would read as its offset.
///
/// Counts that are all 0 or all -1 are those of a register without a value: no format is possible.
///
/// @param counts  > 0 counts as received, in any order.
/// @return        one candidate per format, in the order of temperature_formats().
[[nodiscard]] std::vector<TemperatureCandidate> temperature_candidates(
    std::span<const std::int32_t> counts);

}  // namespace a351::daemon::believable
