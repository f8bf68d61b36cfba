#pragma once
/// @file
/// Differences between devices of the family, as data.  The values are in files: config/profiles has
/// those that the programs contain, and profile-format.md describes their keys.
///
/// A profile is chosen by its name in a configuration or a journal, not by the product identifier
/// that a device reports.  For another device of the same family, write a file;
/// CONTRIBUTING.md describes the steps.
///
///     const DeviceProfile* profile = find_profile("A352AD10");
///     const MilliGal x = to_milligal(profile->acceleration(values.axes[0]));
///     const FilterSpec* filter = profile->filter_named("k512_fc9");
///     const Nanoseconds delay = profile->group_delay(*filter) + profile->data_ready_delay;
///
/// Profiles are constant for the whole run.  All functions may be called from any thread.

#include <cstdint>
#include <filesystem>
#include <optional>
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
    std::uint8_t code = 0;              ///< FILTER_SEL, FILTER_CTRL bits 3:0.
    std::string name;                   ///< "k512_fc9": Kaiser window, taps, cut-off in Hz.
    int taps = 0;                       ///< Number of taps, at the internal rate.
    bool is_user = false;               ///< True if the user loads the coefficients.
    std::vector<int> allowed_rates_hz;  ///< Output rates the data sheet permits (table 5.4).
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
/// Take profiles from find_profile() or load_profile().  A default-constructed profile has no rates
/// and no filters; do not convert with it, because an internal rate of 0 would be a divisor.
struct DeviceProfile {
    /// Name in configurations, journals and metadata; find_profile() finds it.
    std::string name;
    /// First characters of the product identifier.  A device that reports others is still accepted:
    /// DeviceIdentity::has_expected_product_id shows the difference.
    std::string product_id_prefix;
    std::string product_id;               ///< Identifier that an emulated unit reports.
    bool is_verified = false;             ///< True if the values are documented for this device.
    int acceleration_fraction_bits = 0;   ///< g = counts / 2^bits.
    int tilt_fraction_bits = 0;           ///< rad = counts / 2^bits.
    double temperature_slope_degc = 0.0;  ///< degC = slope x counts + offset.
    double temperature_offset_degc = 0.0;
    int temperature_bits = 0;               ///< Width of the temperature counter: 16 or 32 bits.
    int internal_rate_hz = 0;               ///< Conversions per second; COUNT counts them.
    Nanoseconds data_ready_delay{0};        ///< Largest delay of data ready, without the filter's.
    std::chrono::milliseconds start_up{0};  ///< Longest time from power-on to the first access.
    StandardGravity rated_range;            ///< Limit at which the output is clamped, + and -.
    std::vector<Coded> output_rates_hz;     ///< SMPL_CTRL bits 11:8.
    std::vector<Coded> baud_rates;          ///< UART_CTRL bits 9:8.
    std::vector<FilterSpec> filters;
    /// Typical amplitude spectral density of an axis, 1e-6 g / sqrt(Hz); absent if it is not known.
    std::optional<double> noise_ug_per_sqrt_hz;
    std::string toml;  ///< Text of the file; empty for a shipped profile.

    /// Convert raw counts to physical values.
    ///
    ///     acceleration [g]   = counts / 2^acceleration_fraction_bits
    ///     temperature [degC] = temperature_slope_degc x counts + temperature_offset_degc
    ///
    /// The acceleration is exact: no bit is rounded.  The data sheet also prints its unit rounded,
    /// as 0.06 uG, which is 0.66 % too large.
    ///
    /// The temperature is a reference value inside the sensor, not an absolute temperature (7.6).
    /// Its slope is negative for the known devices: -0.0037918 degC per count.
    ///
    /// Every count is converted, special values too (burst-format.md): 0x64000000 gives 100 g.  An
    /// axis that is set to tilt must not be converted by acceleration().
    [[nodiscard]] StandardGravity acceleration(std::int32_t counts) const noexcept;
    [[nodiscard]] DegC temperature(std::int32_t counts) const noexcept;

    /// Returns the counts of a temperature, rounded, and limited to the width of the counter.
    [[nodiscard]] std::int32_t temperature_counts(DegC temperature) const noexcept;

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

/// Returns the profile of that name, or null: a shipped one ("A351", "A352AD10", "A370AD10"), or one
/// that load_profile() or add_recorded_profile() has added.  The pointer is valid for the whole run.
/// Upper and lower case differ: "a351" is unknown.
[[nodiscard]] const DeviceProfile* find_profile(std::string_view name);

/// Returns the names of the shipped profiles, in a fixed order, for lists of permitted values.
[[nodiscard]] std::vector<std::string> profile_names();

/// Reads a profile from a file and adds it.  Its name is that of the file without `.toml`, with a
/// digest of the content ("mine#0a1b2c3d"): files of the same name and another content are different
/// profiles, also in one archive.  A copy of a shipped file gives the shipped profile.
/// @throws InputError  the file cannot be read or breaks the format; one line.
[[nodiscard]] const DeviceProfile& load_profile(const std::filesystem::path& file);

/// Returns the shipped profile of a name, or else that of a file; null if there is neither.
/// @param file  regular file for load_profile(); not read if the name is that of a shipped profile.
/// @throws InputError  as load_profile().
[[nodiscard]] const DeviceProfile* named_or_loaded(std::string_view name,
                                                   const std::filesystem::path& file);

/// The same for an option of a program, whose value is a name or a path.
/// @param option  name of the option, for the message.
/// @throws InputError  there is neither, or as load_profile().
[[nodiscard]] const DeviceProfile& profile_option(std::string_view option,
                                                  const std::string& name_or_file);

/// Adds a profile that a journal contains, so that find_profile() finds it.
/// @param name  the name that load_profile() gave it, with the digest.
/// @param toml  DeviceProfile::toml.
/// @return false if the text does not match the digest or breaks the format: nothing is added.
bool add_recorded_profile(const std::string& name, std::string_view toml);

}  // namespace a351::wire
