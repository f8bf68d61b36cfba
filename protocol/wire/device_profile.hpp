#pragma once
/// @file
/// Differences between devices of the family, as data.  Values of `A352AD10`: Seiko Epson,
/// M-A352AD10 data sheet, rev. 20251023, sections 2, 5, 7.  `A351` is a copy: no public document
/// of the M-A351 is known, so it is marked unverified, also in the metadata.
///
/// A profile is chosen by its name in a configuration or a journal, not by the product identifier
/// that a device reports.  To add a device of the same family, add an entry to the table in
/// device_profile.cpp; CONTRIBUTING.md describes the steps.
///
///     const DeviceProfile* profile = find_profile("A352AD10");
///     const MilliGal x = to_milligal(profile->acceleration(values.axes[0]));
///     const FilterSpec* filter = profile->filter_named("k512_fc9");
///     const Nanoseconds delay = profile->group_delay(*filter) + profile->data_ready_delay;
///
/// Profiles are constant for the whole run.  All functions may be called from any thread.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::wire {

/// Built-in or user-loaded low-pass of the device, selected by FILTER_CTRL.
///
/// The filter works at the internal rate; every (internal rate / output rate)-th result is sent.
/// After the start of sampling the device sends nothing until the filter is filled: 7 samples at
/// 50 Hz with 512 taps (table 5.3).
struct FilterSpec {
    std::uint8_t code = 0;                  ///< FILTER_SEL, FILTER_CTRL bits 3:0.
    std::string_view name;                  ///< "k512_fc9": Kaiser window, taps, cut-off in Hz.
    int taps = 0;                           ///< Number of taps, at the internal rate.
    std::span<const int> allowed_rates_hz;  ///< Output rates the data sheet permits (table 5.4).
};

/// Value of a configuration field and its code in the register.
struct Coded {
    /// Value in the unit of the field: samples/s or baud.
    int value = 0;
    /// Content of the field, its lowest bit at bit 0: shift it to the place of the field.
    std::uint8_t code = 0;
};

/// Description of one type of device.
///
/// Take profiles from find_profile().  The spans and names refer to constant
/// tables, so a copy remains valid.  A default-constructed profile has no rates and no filters; do
/// not convert with it, because an internal rate of 0 would be a divisor.
struct DeviceProfile {
    /// Name in configurations, journals and metadata; find_profile() finds it.
    std::string_view name;
    /// First characters of the product identifier.  A device that reports others is still accepted:
    /// DeviceIdentity::has_expected_product_id shows the difference.
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
    ///
    ///     acceleration [g]   = counts / 2^acceleration_fraction_bits
    ///     temperature [degC] = temperature_slope_degc x counts + temperature_offset_degc
    ///
    /// The acceleration is exact: no bit is rounded.  The data sheet also prints its unit rounded,
    /// as 0.06 uG, which is 0.66 % too large.
    ///
    /// The temperature is a reference value inside the sensor, not an absolute temperature (7.6).
    /// Its slope is negative: -0.0037918 degC per count.
    ///
    /// Every count is converted, special values too (burst-format.md): 0x64000000 gives 100 g.  An
    /// axis that is set to tilt must not be converted by acceleration().
    [[nodiscard]] StandardGravity acceleration(std::int32_t counts) const noexcept;
    [[nodiscard]] DegC temperature(std::int32_t counts) const noexcept;

    /// Returns the COUNT increment between frames: internal rate / output rate.
    /// It is 4, 8, 20, 40, 80 at 1000, 500, 200, 100, 50 Hz (data sheet 7.5).
    /// @param output_rate_hz  > 0 and a divisor of the internal rate; checked by an assertion only.
    ///                        Ask has_output_rate() first if the rate comes from outside.
    [[nodiscard]] std::uint16_t count_step(int output_rate_hz) const noexcept;

    /// Returns true if SMPL_CTRL has a code for this rate.  The filter may still forbid it.
    [[nodiscard]] bool has_output_rate(int output_rate_hz) const noexcept;

    /// Returns the delay of a linear-phase filter: (taps - 1) / 2 internal samples.
    ///
    /// It is 63.875 ms for 512 taps at 4000 Hz.  The values are those of table 5.3
    /// (device_profile_test.cpp).  A user filter has this delay only if its coefficients are
    /// symmetric, which is not known here.
    [[nodiscard]] Nanoseconds group_delay(const FilterSpec& filter) const noexcept;

    /// Return the filter of that name or code; null when the profile has none.
    /// The pointer is valid for the whole run.  Upper and lower case differ in names.
    [[nodiscard]] const FilterSpec* filter_named(std::string_view name) const noexcept;
    [[nodiscard]] const FilterSpec* filter_coded(std::uint8_t code) const noexcept;

    /// Returns the built-in filters that may be used at an output rate, in table order.
    ///
    /// The table decides, not the sampling theorem: 16 Hz at 50 samples/s is not allowed.  With
    /// another pair the device sends 0x64000000 and sets ALIASI_ERR.  User filters are left out,
    /// because their author is responsible for the stop band.
    /// @return names, for messages and configuration; none for a rate that the device lacks.
    [[nodiscard]] std::vector<std::string_view> filters_allowed_at(int output_rate_hz) const;
};

/// Returns the profile of that name ("A351", "A352AD10"), or null.
/// The pointer is valid for the whole run.  Upper and lower case differ: "a351" is unknown.
[[nodiscard]] const DeviceProfile* find_profile(std::string_view name) noexcept;

/// Returns the names of all profiles, in a fixed order, for lists of permitted values.
[[nodiscard]] std::vector<std::string> profile_names();

}  // namespace a351::wire
