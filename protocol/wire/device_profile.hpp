#pragma once
/// @file
/// Differences between devices of the family, as data.  Values of `A352AD10`: Seiko Epson,
/// M-A352AD10 data sheet, rev. 20251023, sections 2, 5, 7.  `A351` is a copy: no public document
/// of the M-A351 is known, so it is marked unverified, also in the metadata.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::wire {

/// Built-in or user-loaded low-pass of the device, selected by FILTER_CTRL.
struct FilterSpec {
    std::uint8_t code = 0;                  ///< FILTER_SEL, FILTER_CTRL bits 3:0.
    std::string_view name;                  ///< "k512_fc9": Kaiser window, taps, cut-off in Hz.
    int taps = 0;                           ///< Number of taps, at the internal rate.
    std::span<const int> allowed_rates_hz;  ///< Output rates the data sheet permits (table 5.4).
};

/// Value of a configuration field and its code in the register.
struct Coded {
    int value = 0;
    std::uint8_t code = 0;
};

struct DeviceProfile {
    std::string_view name;
    std::string_view product_id_prefix;
    bool is_verified = false;             ///< True if the values are documented for this device.
    int acceleration_fraction_bits = 0;   ///< g = counts / 2^bits.
    int tilt_fraction_bits = 0;           ///< rad = counts / 2^bits.
    double temperature_slope_degc = 0.0;  ///< degC = slope x counts + offset.
    double temperature_offset_degc = 0.0;
    int internal_rate_hz = 0;                ///< Conversions per second; COUNT counts them.
    Nanoseconds data_ready_delay{0};         ///< Largest delay of data ready, without the filter's.
    StandardGravity rated_range;             ///< Limit at which the output is clamped, + and -.
    std::span<const Coded> output_rates_hz;  ///< SMPL_CTRL bits 11:8.
    std::span<const Coded> baud_rates;       ///< UART_CTRL bits 9:8.
    std::span<const FilterSpec> filters;

    /// Convert raw counts to physical values.
    [[nodiscard]] StandardGravity acceleration(std::int32_t counts) const noexcept;
    [[nodiscard]] DegC temperature(std::int32_t counts) const noexcept;

    /// Returns the COUNT increment between frames: internal rate / output rate.
    [[nodiscard]] std::uint16_t count_step(int output_rate_hz) const noexcept;

    [[nodiscard]] bool has_output_rate(int output_rate_hz) const noexcept;

    /// Returns the delay of a linear-phase filter: (taps - 1) / 2 internal samples.
    [[nodiscard]] Nanoseconds group_delay(const FilterSpec& filter) const noexcept;

    /// Return the filter of that name or code; null when the profile has none.
    [[nodiscard]] const FilterSpec* filter_named(std::string_view name) const noexcept;
    [[nodiscard]] const FilterSpec* filter_coded(std::uint8_t code) const noexcept;

    /// Returns the built-in filters that may be used at an output rate, in table order.
    [[nodiscard]] std::vector<std::string_view> filters_allowed_at(int output_rate_hz) const;
};

/// Returns the profile of that name ("A351", "A352AD10"), or null.
[[nodiscard]] const DeviceProfile* find_profile(std::string_view name) noexcept;

[[nodiscard]] std::span<const DeviceProfile> all_profiles() noexcept;

}  // namespace a351::wire
